//! The serial line over the board's USB port (CDC-ACM), beside the one on the pins. Its interrupt serves it: a PC gives up a device that does not
//! answer while a picture is drawn.
#![allow(unsafe_code)]

use crate::chip::{TIMER, USB, USB_DPRAM, start_timer};
use crate::rp_hal::clocks::UsbClock;
use crate::rp_hal::pac::{Interrupt, RESETS, interrupt};
use crate::rp_hal::usb::UsbBus;
use board_common::{SerialPort, uart_rx};
use core::cell::RefCell;
use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m::peripheral::NVIC;
use critical_section::Mutex;
use heapless::Deque;
use usb_device::class_prelude::UsbBusAllocator;
use usb_device::device::{StringDescriptors, UsbDevice, UsbDeviceBuilder, UsbDeviceState, UsbVidPid};
use usbd_serial::USB_CLASS_CDC;

/// The shared identity of serial ports that the V-USB project gives away. Programs tell these devices apart by their strings.
const IDENTITY: UsbVidPid = UsbVidPid(0x16c0, 0x27dd);
/// The bytes of a packet, of which the receive buffer must have room.
const PACKET: usize = 64;
/// Bytes that wait until the PC takes them: more than the longest answer to an update.
const CAPACITY: usize = 256;
/// The time after which a PC counts as one that does not read.
const MAX_WAIT_US: u32 = 50_000;

struct UsbLine {
    device: UsbDevice<'static, UsbBus>,
    port: usbd_serial::SerialPort<'static, UsbBus>,
    unsent: Deque<u8, CAPACITY>,
    /// A PC has the port open, but does not read: bytes that find no room are dropped at once.
    is_stuck: bool,
}

static LINE: Mutex<RefCell<Option<UsbLine>>> = Mutex::new(RefCell::new(None));
/// The receive buffer was full, and the interrupt is masked: the port would demand it without pause.
static IS_FULL: AtomicBool = AtomicBool::new(false);

/// Starts the port beside another serial line. When a panic sets the board up a second time, the port goes on as it is.
pub fn start<S: SerialPort>(other: S, clock: UsbClock, resets: &mut RESETS) -> Both<S> {
    let bus = cortex_m::singleton!(: Option<UsbBusAllocator<UsbBus>> = None);
    if let Some(bus) = bus {
        start_timer(resets);
        // Safety: the program takes them nowhere else, and this is done once.
        let (registers, memory) = unsafe { (USB::steal(), USB_DPRAM::steal()) };
        let bus = &*bus.insert(UsbBusAllocator::new(UsbBus::new(registers, memory, clock, true, resets)));
        let port = usbd_serial::SerialPort::new(bus);
        let strings = StringDescriptors::default().manufacturer("Pantin").product(crate::PRODUCT);
        // Control packets of 64 bytes: see the HAL's page on the enumeration by Windows.
        let builder = UsbDeviceBuilder::new(bus, IDENTITY).device_class(USB_CLASS_CDC);
        if let Ok(builder) = builder.strings(&[strings])
            && let Ok(builder) = builder.max_packet_size_0(64)
        {
            let line = UsbLine { device: builder.build(), port, unsent: Deque::new(), is_stuck: false };
            critical_section::with(|section| LINE.borrow(section).replace(Some(line)));
            // Safety: no critical section relies on this interrupt's mask.
            unsafe { NVIC::unmask(Interrupt::USBCTRL_IRQ) };
        }
    }
    Both(other)
}

/// Receives again if the receive buffer was full and has room now.
pub fn resume() {
    if IS_FULL.load(Ordering::Relaxed) && uart_rx::free() >= PACKET {
        IS_FULL.store(false, Ordering::Relaxed);
        // Safety: no critical section relies on this interrupt's mask.
        unsafe { NVIC::unmask(Interrupt::USBCTRL_IRQ) };
    }
}

/// Returns the chip's counter of microseconds.
fn micros() -> u32 {
    // Safety: nothing writes the timer, and this register is only read.
    unsafe { &*TIMER::PTR }.timerawl().read().bits()
}

#[interrupt]
fn USBCTRL_IRQ() {
    with_line(UsbLine::serve);
}

fn with_line<T>(use_line: impl FnOnce(&mut UsbLine) -> T) -> Option<T> {
    critical_section::with(|section| LINE.borrow(section).try_borrow_mut().ok()?.as_mut().map(use_line))
}

impl UsbLine {
    /// Answers the PC, and moves bytes from it and to it.
    fn serve(&mut self) {
        self.device.poll(&mut [&mut self.port]);
        let mut packet = [0; PACKET];
        loop {
            if uart_rx::free() < PACKET {
                IS_FULL.store(true, Ordering::Relaxed);
                NVIC::mask(Interrupt::USBCTRL_IRQ);
                break;
            }
            match self.port.read(&mut packet) {
                Ok(count) if count > 0 => packet.iter().take(count).for_each(|byte| uart_rx::push(*byte)),
                _ => break,
            }
        }
        while let (bytes, _) = self.unsent.as_slices()
            && !bytes.is_empty()
            && let Ok(count @ 1..) = self.port.write(bytes)
        {
            (0..count).for_each(|_| _ = self.unsent.pop_front());
            self.is_stuck = false;
        }
        // What the port cannot send now, it sends after the packet that is on its way.
        let _ = self.port.flush();
    }

    /// Sends what there is room for, and returns how many bytes it took: all of them while no PC has the port open.
    fn send(&mut self, bytes: &[u8]) -> usize {
        if self.device.state() != UsbDeviceState::Configured || !self.port.dtr() {
            self.unsent.clear();
            self.is_stuck = false;
            return bytes.len();
        }
        let taken = bytes.iter().take_while(|byte| self.unsent.push_back(**byte).is_ok()).count();
        self.serve();
        if self.is_stuck { bytes.len() } else { taken }
    }
}

/// The line over USB and another one: both send the same, and what either receives is in one buffer.
pub struct Both<S>(S);

impl<S: SerialPort> SerialPort for Both<S> {
    fn send(&mut self, bytes: &[u8]) {
        let (mut rest, begun) = (bytes, micros());
        loop {
            // No line: nothing to wait for.
            let taken = with_line(|line| line.send(rest)).unwrap_or(rest.len());
            rest = rest.get(taken..).unwrap_or_default();
            if rest.is_empty() {
                break;
            }
            if micros().wrapping_sub(begun) > MAX_WAIT_US {
                with_line(|line| line.is_stuck = true);
                break;
            }
        }
        self.0.send(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        uart_rx::pop()
    }
}
