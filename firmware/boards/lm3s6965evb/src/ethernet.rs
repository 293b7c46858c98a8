//! The board's Ethernet as a source of bytes: the payloads of UDP datagrams to port [`PORT`], in order (`smoltcp`).
//!
//! Its address is the fixed one of QEMU's user network, 10.0.2.15. It sends nothing but answers to address requests.

use crate::registers::{mac, system};
use heapless::Vec;
use smoltcp::iface::{Config, Interface, SocketHandle, SocketSet, SocketStorage};
use smoltcp::phy::{self, Device, DeviceCapabilities, Medium};
use smoltcp::socket::udp;
use smoltcp::time::Instant;
use smoltcp::wire::{EthernetAddress, IpAddress, IpCidr, Ipv4Address};
use static_cell::StaticCell;

/// The UDP port that receives motion.
pub const PORT: u16 = 4000;
const ADDRESS: Ipv4Address = Ipv4Address::new(10, 0, 2, 15);
const NETWORK_BITS: u8 = 24;
const HARDWARE: EthernetAddress = EthernetAddress([0x02, 0, 0, 0x50, 0x61, 0x6e]);

/// The longest Ethernet frame without its checksum.
const FRAME: usize = 1514;
/// Bytes that the controller adds to a frame: its length before it, the checksum after it.
const LENGTH_BYTES: usize = 2;
const CHECK_BYTES: usize = 4;
/// The controller's length of a frame to send leaves the header out.
const HEADER_BYTES: usize = 14;
/// Most datagrams that wait, and their bytes.
const DATAGRAMS: usize = 8;
const WAITING: usize = 1024;

const CLOCK: u32 = 1 << 28 | 1 << 30;
const RECEIVE_ON: u32 = 1;
const SEND_ON: u32 = 1 | PAD | SUM;
const PAD: u32 = 1 << 1;
const SUM: u32 = 1 << 2;
const SEND_NOW: u32 = 1;

/// Buffers of the network, which it needs as long as the program runs.
static SOCKETS: StaticCell<[SocketStorage<'static>; 1]> = StaticCell::new();
static HEADERS: StaticCell<[udp::PacketMetadata; DATAGRAMS]> = StaticCell::new();
static BYTES: StaticCell<[u8; WAITING]> = StaticCell::new();

/// The source of bytes.
pub struct Ethernet {
    controller: Controller,
    interface: Interface,
    sockets: SocketSet<'static>,
    socket: SocketHandle,
    /// A datagram, and how much of it has been returned.
    datagram: Vec<u8, WAITING>,
    next: usize,
}

impl Ethernet {
    /// Starts the controller, once.
    pub fn new() -> Self {
        let mut controller = Controller::new();
        // Time only ages neighbour addresses. This program sends nothing to neighbours, so time may stand still.
        let mut interface = Interface::new(Config::new(HARDWARE.into()), &mut controller, Instant::ZERO);
        interface.update_ip_addrs(|addresses| {
            // There is room for one address.
            let _ = addresses.push(IpCidr::new(IpAddress::Ipv4(ADDRESS), NETWORK_BITS));
        });
        let headers = HEADERS.init([udp::PacketMetadata::EMPTY; DATAGRAMS]);
        let received = udp::PacketBuffer::new(&mut headers[..], &mut BYTES.init([0; WAITING])[..]);
        let mut socket = udp::Socket::new(received, udp::PacketBuffer::new(&mut [][..], &mut [][..]));
        // This fails only for port 0 or a bound socket.
        let _ = socket.bind(PORT);
        let mut sockets = SocketSet::new(&mut SOCKETS.init([SocketStorage::EMPTY])[..]);
        let socket = sockets.add(socket);
        Ethernet { controller, interface, sockets, socket, datagram: Vec::new(), next: 0 }
    }

    /// Returns the next byte, if one was received.
    pub fn poll(&mut self) -> Option<u8> {
        if self.next >= self.datagram.len() {
            self.interface.poll(Instant::ZERO, &mut self.controller, &mut self.sockets);
            let socket = self.sockets.get_mut::<udp::Socket>(self.socket);
            let (bytes, _) = socket.recv().ok()?;
            self.datagram.clear();
            // A datagram is no longer than the buffer that it waited in.
            let _ = self.datagram.extend_from_slice(bytes);
            self.next = 0;
        }
        let byte = self.datagram.get(self.next).copied();
        self.next += 1;
        byte
    }
}

/// The controller (data sheet, chapter 17). Whole frames pass through two queues of words.
struct Controller {
    frame: [u8; FRAME],
}

impl Controller {
    fn new() -> Self {
        system::RCGC2.write(system::RCGC2.read() | CLOCK);
        let [a, b, c, d, e, f] = HARDWARE.0;
        mac::IA0.write(u32::from_le_bytes([a, b, c, d]));
        mac::IA1.write(u32::from_le_bytes([e, f, 0, 0]));
        mac::TCTL.write(SEND_ON);
        mac::RCTL.write(RECEIVE_ON);
        Controller { frame: [0; FRAME] }
    }

    /// Takes the oldest frame out of the queue and returns its length.
    fn take(&mut self) -> Option<usize> {
        if mac::NP.read() == 0 {
            return None;
        }
        let [low, high, first, second] = mac::DATA.read().to_le_bytes();
        let length = usize::from(u16::from_le_bytes([low, high]));
        let len = length.saturating_sub(LENGTH_BYTES + CHECK_BYTES);
        let words = length.div_ceil(4).saturating_sub(1);
        let rest = (0..words).flat_map(|_| mac::DATA.read().to_le_bytes());
        // All words must be read, even those of a frame that is too long, and the checksum.
        for (at, byte) in [first, second].into_iter().chain(rest).enumerate() {
            if let Some(place) = self.frame.get_mut(at) {
                *place = byte;
            }
        }
        Some(len.min(FRAME))
    }

    /// Sends a frame.
    fn put(frame: &[u8]) {
        while mac::TR.read() & SEND_NOW != 0 {}
        let [low, high] = (frame.len().saturating_sub(HEADER_BYTES) as u16).to_le_bytes();
        let mut word = [low, high, 0, 0];
        let mut filled = LENGTH_BYTES;
        for &byte in frame {
            word[filled & 3] = byte;
            filled += 1;
            if filled & 3 == 0 {
                mac::DATA.write(u32::from_le_bytes(word));
                word = [0; 4];
            }
        }
        if filled & 3 != 0 {
            mac::DATA.write(u32::from_le_bytes(word));
        }
        mac::TR.write(SEND_NOW);
    }
}

impl Device for Controller {
    type RxToken<'a> = Received<'a>;
    type TxToken<'a> = Sending;

    fn receive(&mut self, _: Instant) -> Option<(Received<'_>, Sending)> {
        let len = self.take()?;
        Some((Received(self.frame.get(..len)?), Sending))
    }

    fn transmit(&mut self, _: Instant) -> Option<Sending> {
        Some(Sending)
    }

    fn capabilities(&self) -> DeviceCapabilities {
        let mut capabilities = DeviceCapabilities::default();
        capabilities.medium = Medium::Ethernet;
        capabilities.max_transmission_unit = FRAME;
        capabilities.max_burst_size = Some(1);
        capabilities
    }
}

/// A received frame.
struct Received<'a>(&'a [u8]);

impl phy::RxToken for Received<'_> {
    fn consume<R, F: FnOnce(&[u8]) -> R>(self, see: F) -> R {
        see(self.0)
    }
}

/// A permission to send one frame.
struct Sending;

/// The longest frame that is sent: an answer to an address request, or a port-unreachable message.
const ANSWER: usize = 600;

impl phy::TxToken for Sending {
    fn consume<R, F: FnOnce(&mut [u8]) -> R>(self, len: usize, fill: F) -> R {
        let mut frame = [0; ANSWER];
        // The longest answer has 576 bytes of IP (RFC 1812).
        let frame = frame.get_mut(..len.min(ANSWER)).unwrap_or_default();
        let filled = fill(frame);
        Controller::put(frame);
        filled
    }
}
