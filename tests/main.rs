mod il_fx;

fn main() {}
