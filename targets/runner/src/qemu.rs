//! A machine under QEMU: started, listened to, and never left behind.

use std::ffi::{OsStr, OsString};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use rhogrid::error::Error;

use crate::failure;
use crate::machine::Machine;

const QEMU: &str = "qemu-system-arm";

/// How long a machine may be silent. Hundreds of millions of instructions
/// take a second; a line takes at most a few of those.
const SILENCE: Duration = Duration::from_secs(300);

/// Checks that QEMU is there and has the machine.
///
/// # Errors
/// When not; says what to do.
pub fn check(machine: &Machine) -> Result<(), Error> {
    let remedy = format!("install {QEMU} (Debian, Ubuntu: apt-get install qemu-system-arm)");
    let output = Command::new(QEMU)
        .args(["-machine", "help"])
        .stdin(Stdio::null())
        .output()
        .map_err(|error| failure(format!("cannot run {QEMU}: {error}"), remedy))?;
    if !has_machine(&String::from_utf8_lossy(&output.stdout), machine.qemu) {
        return Err(failure(
            format!("this {QEMU} has no machine {}", machine.qemu),
            "use QEMU 7.2, which has",
        ));
    }
    Ok(())
}

/// Checks that QEMU takes a `-plugin` option; the plugin must end QEMU with
/// code 0.
///
/// # Errors
/// When not; in QEMU's words.
pub fn check_plugin(option: &OsStr) -> Result<(), Error> {
    let output = Command::new(QEMU)
        .args(["-machine", "none", "-display", "none", "-plugin"])
        .arg(option)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| failure(format!("cannot run {QEMU}: {error}"), ""))?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        return Err(failure(
            format!("this {QEMU} does not load the plugin: {}", complaint.trim()),
            "use QEMU 7.2 with plugins enabled, as Debian's is",
        ));
    }
    Ok(())
}

/// Whether the output of `-machine help` lists a machine.
fn has_machine(help: &str, name: &str) -> bool {
    help.lines()
        .any(|line| line.split_whitespace().next() == Some(name))
}

/// A running QEMU. Dropping it ends it.
#[derive(Debug)]
pub struct Guest {
    child: Child,
    lines: Receiver<String>,
    complaints: Option<JoinHandle<String>>,
}

impl Guest {
    /// Starts a machine with its firmware and a frame file in memory; QMP
    /// listens on `socket`, and the option `plugin`, if any, loads a plugin.
    ///
    /// # Errors
    /// When QEMU cannot be started.
    pub fn start(
        machine: &Machine,
        firmware: &Path,
        frame_file: &Path,
        socket: &Path,
        plugin: Option<&OsStr>,
    ) -> Result<Self, Error> {
        let mut child = Command::new(QEMU)
            .args(arguments(machine, firmware, frame_file, socket))
            .args(
                plugin
                    .iter()
                    .flat_map(|option| [OsStr::new("-plugin"), option]),
            )
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| failure(format!("cannot run {QEMU}: {error}"), ""))?;
        let (sender, lines) = channel();
        if let Some(stdout) = child.stdout.take() {
            thread::spawn(move || {
                let lines = BufReader::new(stdout).lines();
                for line in lines.map_while(Result::ok) {
                    if sender.send(line).is_err() {
                        break;
                    }
                }
            });
        }
        let complaints = child.stderr.take().map(|mut stderr| {
            thread::spawn(move || {
                let mut bytes = Vec::new();
                // What was read before a failure is still worth showing.
                let _ = stderr.read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        Ok(Self {
            child,
            lines,
            complaints,
        })
    }

    /// The next line that the firmware prints.
    ///
    /// # Errors
    /// When QEMU ends or is silent for too long.
    pub fn line(&mut self) -> Result<String, Error> {
        self.line_within(SILENCE)
    }

    fn line_within(&mut self, time: Duration) -> Result<String, Error> {
        self.lines.recv_timeout(time).map_err(|error| match error {
            RecvTimeoutError::Timeout => failure(
                format!("the machine printed nothing for {} s", time.as_secs()),
                "it hangs, or the asset is too large for it",
            ),
            RecvTimeoutError::Disconnected => self.ended(),
        })
    }

    /// Why there will be no more lines, in QEMU's words.
    fn ended(&mut self) -> Error {
        self.stop();
        let complaints = self.complaints.take().and_then(|thread| thread.join().ok());
        failure(
            format!("{QEMU} ended too early"),
            format!("it said: {}", complaints.unwrap_or_default().trim()),
        )
    }

    fn stop(&mut self) {
        // Both fail only if it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        self.stop();
    }
}

/// All of QEMU's arguments.
fn arguments(
    machine: &Machine,
    firmware: &Path,
    frame_file: &Path,
    socket: &Path,
) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = ["-machine", machine.qemu]
        .iter()
        .chain(machine.qemu_arguments)
        .map(OsString::from)
        .collect();
    let fixed = [
        // No device that is not asked for, no window, no sound.
        "-nodefaults -display none -nic none -audiodev none,id=silent",
        "-chardev stdio,id=guest",
        "-semihosting-config enable=on,target=native,chardev=guest",
    ];
    arguments.extend(fixed.join(" ").split(' ').map(OsString::from));
    arguments.push("-icount".into());
    arguments.push(format!("shift={},sleep=off", machine.clock.icount_shift).into());
    arguments.push("-qmp".into());
    arguments.push(option("unix:", socket, ",server=on,wait=off"));
    arguments.push("-kernel".into());
    arguments.push(firmware.into());
    arguments.push("-device".into());
    let place = format!(",addr={:#x},force-raw=on", machine.window.address);
    arguments.push(option("loader,file=", frame_file, &place));
    arguments
}

/// A path inside one of QEMU's comma-separated options: its own commas are
/// doubled.
pub fn option(before: &str, path: &Path, after: &str) -> OsString {
    let path = path.to_string_lossy().replace(',', ",,");
    format!("{before}{path}{after}").into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::MACHINES;
    use std::time::Instant;

    fn guest(script: &str) -> Guest {
        let mut child = Command::new("sh")
            .args(["-c", script])
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell");
        let stdout = child.stdout.take().expect("piped");
        let (sender, lines) = channel();
        thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        Guest {
            child,
            lines,
            complaints: None,
        }
    }

    #[test]
    fn lines_come_one_by_one_and_then_the_end() {
        let mut guest = guest("echo one; echo two");
        assert_eq!(guest.line(), Ok("one".to_owned()));
        assert_eq!(guest.line(), Ok("two".to_owned()));
        let error = guest.line().expect_err("ended");
        assert!(error.what.contains("ended too early"), "{error}");
    }

    #[test]
    fn silence_has_an_end_and_nothing_is_left_behind() {
        let start = Instant::now();
        let mut guest = guest("exec sleep 100");
        let error = guest
            .line_within(Duration::from_millis(50))
            .expect_err("silent");
        assert!(error.what.contains("printed nothing"), "{error}");
        drop(guest);
        assert!(start.elapsed() < Duration::from_secs(50));
    }

    #[test]
    fn machines_are_found_by_whole_names() {
        let help = "Supported machines are:\nversatilepb   ARM Versatile/PB\nmps2-an385 x\n";
        assert!(has_machine(help, "versatilepb"));
        assert!(!has_machine(help, "versatile"));
        assert!(!has_machine(help, "ARM"));
    }

    #[test]
    fn commas_in_paths_are_doubled() {
        let [kernel, frame, socket] = ["/a,b/k", "/a,b/f", "/a,b/s"].map(Path::new);
        let arguments = arguments(&MACHINES[0], kernel, frame, socket);
        let has = |wanted: &str| arguments.iter().any(|argument| argument == wanted);
        assert!(has("unix:/a,,b/s,server=on,wait=off"));
        assert!(has("loader,file=/a,,b/f,addr=0x4000000,force-raw=on"));
        assert!(has("/a,b/k"));
        assert!(has("shift=10,sleep=off"));
    }
}
