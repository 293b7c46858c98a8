//! Output and the program's end by semihosting.

use core::panic::PanicInfo;
use semihosting::io::{Write, stdout};

/// Lines gathered into one call of the host.
const GATHERED: usize = 400;

/// Runs the program: ends with code 0 if everything played, 1 if not, 2 if it could not be printed.
pub fn main() -> ! {
    let Ok(mut out) = stdout() else { semihosting::process::exit(2) };
    let mut gathered = [0; GATHERED];
    let mut len = 0;
    let mut printed = true;
    let played = crate::vectors::run(&mut |text| {
        if len + text.len() > GATHERED {
            printed &= out.write_all(&gathered[..len]).is_ok();
            len = 0;
        }
        gathered[len..len + text.len()].copy_from_slice(text);
        len += text.len();
    });
    printed &= out.write_all(&gathered[..len]).is_ok();
    semihosting::process::exit(if !printed { 2 } else { i32::from(!played) })
}

#[panic_handler]
fn panic(_info: &PanicInfo) -> ! {
    semihosting::process::exit(101)
}
