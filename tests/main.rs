mod ladder_read;
