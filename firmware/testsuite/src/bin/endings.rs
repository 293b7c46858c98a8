//! Ends as its semihosting argument says: `exit` and a code, `panic`, `fault`, or never (`spin`).
#![no_std]
#![no_main]

use testsuite as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    // QEMU joins its `arg=` values with spaces into one command line.
    let Ok(arguments) = semihosting::experimental::env::args::<64>() else { panic!() };
    let mut arguments = arguments.flatten();
    match arguments.next() {
        Some("exit") => semihosting::process::exit(arguments.next().and_then(|code| code.parse().ok()).unwrap_or(1)),
        Some("fault") => cortex_m::asm::udf(),
        Some("spin") => loop {
            cortex_m::asm::nop();
        },
        _ => panic!(),
    }
}
