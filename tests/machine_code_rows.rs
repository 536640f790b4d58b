//! Machine code of every row of the instruction table, and the two identities, on random programs and random words.
