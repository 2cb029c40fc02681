//! `roadmill`: the program. The crate's library holds all of it, where benches and tests reach it.

fn main() -> std::process::ExitCode {
    roadmill_coordinator::main()
}
