//! QEMU as a child process: it never outlives its time limit or its value in the program.

use std::io::{ErrorKind, Read};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail};
use tempfile::TempDir;

use crate::display::{self, Display, Picture, Way};
use crate::qmp::Qmp;
use crate::{screen, setup};

/// Interval between checks of a process or socket that is not ready.
const POLL: Duration = Duration::from_millis(2);

/// A machine that QEMU emulates.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    /// The program that emulates it.
    pub emulator: &'static str,
    /// Its name in this project: the name of its firmware's package.
    pub name: &'static str,
    /// QEMU's name for it.
    pub model: &'static str,
    /// The Rust target of its programs.
    pub target: &'static str,
    /// Further arguments for QEMU.
    pub options: &'static [&'static str],
    /// The display of its firmware.
    pub display: Option<Display>,
}

/// Cortex-M3 with 64 KiB RAM, 256 KiB flash and an OLED of 128x64 pixels in 16 greys.
pub const LM3S6965EVB: Machine = arm("lm3s6965evb", "thumbv7m-none-eabi", display::OLED);

/// Cortex-M0 with 16 KiB RAM and 256 KiB flash.
pub const MICROBIT: Machine = arm("microbit", "thumbv6m-none-eabi", display::PAGES);

/// Cortex-M4F with 4 MiB of each.
pub const MPS2_AN386: Machine = arm("mps2-an386", "thumbv7em-none-eabihf", display::GREYS);

/// Cortex-M33 with 4 MiB of each.
pub const MPS2_AN505: Machine = arm("mps2-an505", "thumbv8m.main-none-eabihf", display::GREYS);

/// ARM925T, ARMv4T: Siemens SX1, a phone of 2003.
pub const SX1: Machine = arm("sx1", "armv4t-none-eabi", display::LCD);

/// The machines that play clips on a display.
pub const BOARDS: [Machine; 5] = [LM3S6965EVB, MICROBIT, MPS2_AN386, RISCV_VIRT, SX1];

/// Returns the machine of [`BOARDS`] with this name.
pub fn board(name: &str) -> Result<Machine> {
    BOARDS.into_iter().find(|board| board.name == name).with_context(|| {
        let names: Vec<&str> = BOARDS.iter().map(|board| board.name).collect();
        format!("no board is called {name}; there are {}", names.join(", "))
    })
}

const fn arm(name: &'static str, target: &'static str, display: Display) -> Machine {
    Machine { emulator: "qemu-system-arm", name, model: name, target, options: &[], display: Some(display) }
}

/// RV32IMAC, entered without firmware.
pub const VIRT: Machine = Machine {
    emulator: "qemu-system-riscv32",
    name: "virt",
    model: "virt",
    target: "riscv32imac-unknown-none-elf",
    options: &["-bios", "none"],
    display: None,
};

/// The same machine with the ESP32-C3's instructions, RV32IMC, and its display's layout.
pub const RISCV_VIRT: Machine =
    Machine { name: "riscv-virt", target: "riscv32imc-unknown-none-elf", display: Some(display::PAGES), ..VIRT };

/// What to start, and the devices to attach.
#[derive(Clone, Debug)]
pub struct Launch {
    machine: Machine,
    elf: PathBuf,
    arguments: Vec<String>,
    serial: bool,
    line: Option<String>,
    network: Option<String>,
    display: bool,
    plugin: Option<(PathBuf, PathBuf)>,
    loaded: Option<(PathBuf, u32)>,
    limit: Duration,
}

impl Launch {
    /// The machine.
    pub fn machine(&self) -> Machine {
        self.machine
    }

    /// Makes a run of `elf` with a limit of 60 s, semihosting, and no other devices.
    pub fn new(machine: Machine, elf: &Path) -> Self {
        let limit = Duration::from_secs(60);
        Self {
            machine,
            elf: elf.into(),
            arguments: vec![],
            serial: false,
            line: None,
            network: None,
            display: false,
            plugin: None,
            loaded: None,
            limit,
        }
    }

    /// Appends a word to the command line that the program reads by semihosting.
    pub fn argument(mut self, word: impl Into<String>) -> Self {
        self.arguments.push(word.into());
        self
    }

    /// Connects the machine's first serial port.
    pub fn serial(mut self) -> Self {
        self.serial = true;
        self
    }

    /// Connects the machine's first serial port to what QEMU calls a character device.
    pub fn serial_at(mut self, device: &str) -> Self {
        self.line = Some(device.into());
        self
    }

    /// Connects the machine's network to what QEMU calls a network backend.
    pub fn network(mut self, backend: &str) -> Self {
        self.network = Some(backend.into());
        self
    }

    /// Connects the machine's display and keys.
    pub fn display(mut self) -> Self {
        self.display = true;
        self
    }

    /// Counts instructions with the plugin of [`crate::icount`] into a file, read by [`crate::icount::read`].
    pub fn counting(mut self, plugin: &Path, counts: &Path) -> Self {
        self.plugin = Some((plugin.into(), counts.into()));
        self
    }

    /// Puts a file's bytes into the machine's memory before it starts, into flash too.
    pub fn loading(mut self, file: &Path, address: u32) -> Self {
        self.loaded = Some((file.into(), address));
        self
    }

    /// Sets the time limit.
    pub fn limit(mut self, limit: Duration) -> Self {
        self.limit = limit;
        self
    }

    /// Starts QEMU, and waits until the requested devices are connected.
    pub fn start(self) -> Result<Qemu> {
        let emulator = setup::emulator(self.machine.emulator)?;
        let directory = tempfile::Builder::new().prefix("pantin-qemu-").tempdir().context("cannot make a temporary folder")?;
        let listen = |wanted: bool, name| wanted.then(|| UnixListener::bind(directory.path().join(name))).transpose();
        let serial = listen(self.serial, "serial").context("cannot make a socket")?;
        let control = listen(self.display, "qmp").context("cannot make a socket")?;
        let mut command = Command::new(&emulator);
        command.args(self.command_line(directory.path())).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().with_context(|| format!("cannot start {}", emulator.display()))?;
        let (stdout, stderr) = (collect(child.stdout.take()), collect(child.stderr.take()));
        let deadline = Instant::now() + self.limit;
        let limit = self.limit;
        let machine = self.machine;
        let mut qemu = Qemu { machine, child, stdout, stderr, directory, serial: None, control: None, limit, deadline };
        qemu.serial = serial.map(|socket| qemu.accept(&socket)).transpose()?;
        if let Some(socket) = control {
            let stream = qemu.accept(&socket)?;
            qemu.control = Some(Qmp::new(stream, limit).map_err(|error| qemu.explain(error))?);
        }
        Ok(qemu)
    }

    fn command_line(&self, directory: &Path) -> Vec<String> {
        let socket = |wanted, name| match wanted {
            true => format!("unix:{}", escaped(&directory.join(name))),
            false => "none".to_owned(),
        };
        let mut semihosting = "enable=on,target=native".to_owned();
        for argument in &self.arguments {
            semihosting.push_str(&format!(",arg={}", argument.replace(',', ",,")));
        }
        let elf = self.elf.display().to_string();
        let mut line: Vec<String> =
            ["-M", self.machine.model, "-display", "none", "-monitor", "none", "-kernel", &elf].map(String::from).into();
        let serial = self.line.clone().unwrap_or_else(|| socket(self.serial, "serial"));
        line.extend(["-serial".into(), serial, "-semihosting-config".into(), semihosting]);
        line.extend(self.machine.options.iter().map(|option| (*option).to_owned()));
        if let Some(backend) = &self.network {
            line.extend(["-nic".into(), backend.clone()]);
        }
        if self.display {
            line.extend(["-qmp".into(), socket(true, "qmp")]);
        }
        if let Some((file, address)) = &self.loaded {
            let option = format!("loader,file={},addr={address:#x},force-raw=on", escaped(file));
            line.extend(["-device".into(), option]);
        }
        if let Some((plugin, counts)) = &self.plugin {
            line.extend(["-plugin".into(), format!("{},out={}", escaped(plugin), escaped(counts))]);
        }
        line
    }
}

/// The results of a finished run.
#[derive(Debug)]
pub struct Outcome {
    /// The exit code; a signal's number negated where one ended QEMU.
    pub code: i32,
    /// Everything on stdout: what the program wrote by semihosting.
    pub stdout: Vec<u8>,
    /// Everything on stderr: QEMU's messages.
    pub stderr: String,
}

/// A running QEMU. Dropping it kills it.
pub struct Qemu {
    machine: Machine,
    child: Child,
    stdout: JoinHandle<Vec<u8>>,
    stderr: JoinHandle<Vec<u8>>,
    directory: TempDir,
    serial: Option<UnixStream>,
    control: Option<Qmp>,
    limit: Duration,
    deadline: Instant,
}

impl Qemu {
    /// The process's id.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// The first serial port; reading waits no longer than the run's time limit.
    pub fn serial(&mut self) -> Result<&mut UnixStream> {
        let left = self.left()?;
        let serial = self.serial.as_mut().context("this run has no serial port")?;
        serial.set_read_timeout(Some(left))?;
        Ok(serial)
    }

    /// The control connection.
    pub fn control(&mut self) -> Result<&mut Qmp> {
        self.left()?;
        self.control.as_mut().context("this run has no display")
    }

    /// The machine.
    pub fn machine(&self) -> Machine {
        self.machine
    }

    /// Returns the current picture of the display in QEMU's window.
    pub fn picture(&mut self) -> Result<Picture> {
        let Some(display @ Display { way: Way::Window(scale), .. }) = self.machine.display else {
            bail!("QEMU shows no display of {}", self.machine.name);
        };
        let path = self.directory.path().join("screen.ppm");
        self.control()?.screendump(&path).map_err(|error| self.explain(error))?;
        let dump = std::fs::read(&path).context("QEMU left no picture")?;
        screen::from_window(&dump, display, scale)
    }

    /// Waits for the end and returns the results.
    ///
    /// # Errors
    /// The time limit was reached first.
    pub fn wait(mut self) -> Result<Outcome> {
        // Closed connections would hold QEMU up no longer than the program's end, and a full socket not at all.
        let status = self.ended()?;
        let stdout = take(&mut self.stdout);
        let stderr = String::from_utf8_lossy(&take(&mut self.stderr)).into_owned();
        Ok(Outcome { code: code(status), stdout, stderr })
    }

    /// Adds QEMU's messages and its exit code, if it ended, to the error of a connection: they are the cause.
    pub fn explain(&mut self, error: anyhow::Error) -> anyhow::Error {
        // A connection that is closed is one of a QEMU that ends, however long a busy machine takes for that.
        let until = if is_closed(&error) { self.deadline } else { Instant::now() + POLL * 10 };
        loop {
            if let Ok(Some(status)) = self.child.try_wait() {
                let words = String::from_utf8_lossy(&take(&mut self.stderr)).trim().to_owned();
                return error.context(format!("QEMU ended with code {}: {words}", code(status)));
            }
            if Instant::now() >= self.deadline {
                return error.context(format!("QEMU ran longer than {:?}", self.limit));
            }
            if Instant::now() >= until {
                return error;
            }
            thread::sleep(POLL);
        }
    }

    fn ended(&mut self) -> Result<ExitStatus> {
        loop {
            if let Some(status) = self.child.try_wait()? {
                return Ok(status);
            }
            self.left()?;
            thread::sleep(POLL);
        }
    }

    fn accept(&mut self, socket: &UnixListener) -> Result<UnixStream> {
        socket.set_nonblocking(true)?;
        loop {
            match socket.accept() {
                Ok((stream, _)) => {
                    stream.set_nonblocking(false)?;
                    return Ok(stream);
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => thread::sleep(POLL),
                Err(error) => return Err(error.into()),
            }
            if self.child.try_wait()?.is_some() {
                return Err(self.explain(anyhow!("QEMU did not start")));
            }
            self.left()?;
        }
    }

    fn left(&self) -> Result<Duration> {
        match self.deadline.checked_duration_since(Instant::now()) {
            Some(left) if !left.is_zero() => Ok(left),
            _ => bail!("QEMU ran longer than {:?}", self.limit),
        }
    }
}

/// Whether an error is that the other side closed the connection.
fn is_closed(error: &anyhow::Error) -> bool {
    let kinds = [ErrorKind::ConnectionReset, ErrorKind::BrokenPipe, ErrorKind::UnexpectedEof];
    error.chain().filter_map(|cause| cause.downcast_ref::<std::io::Error>()).any(|error| kinds.contains(&error.kind()))
}

impl Drop for Qemu {
    fn drop(&mut self) {
        // Both fail only where the process is gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn collect(stream: Option<impl Read + Send + 'static>) -> JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = vec![];
        if let Some(mut stream) = stream {
            let _ = stream.read_to_end(&mut bytes);
        }
        bytes
    })
}

fn take(thread: &mut JoinHandle<Vec<u8>>) -> Vec<u8> {
    std::mem::replace(thread, thread::spawn(Vec::new)).join().unwrap_or_default()
}

fn code(status: ExitStatus) -> i32 {
    use std::os::unix::process::ExitStatusExt;
    status.code().or_else(|| status.signal().map(|signal| -signal)).unwrap_or(-1)
}

/// A path inside one of QEMU's options, where a comma ends a value unless it is doubled.
fn escaped(path: &Path) -> String {
    path.display().to_string().replace(',', ",,")
}
