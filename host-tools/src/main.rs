//! `pantin`: the host tool.

fn main() {}
