//! Start and faults of a Cortex-M.

#[cortex_m_rt::entry]
fn main() -> ! {
    crate::semihosted::main()
}

// The attribute declares the handler unsafe: a fault can strike anywhere. It touches nothing but the exit call.
#[allow(unsafe_code)]
#[cortex_m_rt::exception]
unsafe fn HardFault(_frame: &cortex_m_rt::ExceptionFrame) -> ! {
    semihosting::process::exit(102)
}
