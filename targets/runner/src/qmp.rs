//! QEMU's machine protocol over a socket: JSON, one message a line.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use rhogrid::error::Error;
use serde_json::{Value, json};

use crate::failure;

/// How long QEMU may take for an answer.
const ANSWER_TIME: Duration = Duration::from_secs(30);

/// A connection in command mode.
#[derive(Debug)]
pub struct Qmp {
    reader: BufReader<UnixStream>,
    writer: UnixStream,
}

impl Qmp {
    /// Connects and leaves capability negotiation.
    ///
    /// # Errors
    /// When nobody listens there, or it is not QEMU.
    pub fn connect(socket: &Path) -> Result<Self, Error> {
        let open = || {
            let writer = UnixStream::connect(socket)?;
            writer.set_read_timeout(Some(ANSWER_TIME))?;
            writer.set_write_timeout(Some(ANSWER_TIME))?;
            let reader = BufReader::new(writer.try_clone()?);
            Ok(Self { reader, writer })
        };
        let mut qmp = open().map_err(trouble)?;
        if qmp.receive()?.get("QMP").is_none() {
            return Err(failure("QMP: no greeting", ""));
        }
        qmp.execute("qmp_capabilities", &json!({}))?;
        Ok(qmp)
    }

    /// Sends a command, waits for its answer, skips events before it.
    ///
    /// # Errors
    /// When QEMU refuses it or does not answer.
    pub fn execute(&mut self, command: &str, arguments: &Value) -> Result<Value, Error> {
        let message = json!({ "execute": command, "arguments": arguments });
        writeln!(self.writer, "{message}").map_err(trouble)?;
        loop {
            let mut answer = self.receive()?;
            if let Some(value) = answer.get_mut("return") {
                return Ok(value.take());
            }
            if let Some(error) = answer.get("error") {
                let reason = error["desc"].as_str().unwrap_or("no reason given");
                return Err(failure(format!("QMP: {command} failed: {reason}"), ""));
            }
        }
    }

    /// Writes the machine's screen as a PPM file.
    ///
    /// # Errors
    /// When QEMU cannot.
    pub fn screendump(&mut self, file: &Path) -> Result<(), Error> {
        self.execute("screendump", &json!({ "filename": file }))
            .map(drop)
    }

    fn receive(&mut self) -> Result<Value, Error> {
        let mut line = String::new();
        if self.reader.read_line(&mut line).map_err(trouble)? == 0 {
            return Err(failure("QMP: QEMU closed the connection", ""));
        }
        serde_json::from_str(&line)
            .map_err(|error| failure(format!("QMP: not JSON ({error}): {line:?}"), ""))
    }
}

fn trouble(error: std::io::Error) -> Error {
    failure(format!("QMP: {error}"), "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::net::UnixListener;
    use std::thread::{self, JoinHandle};

    const GREETING: &str = r#"{"QMP": {"version": {}, "capabilities": []}}"#;
    const EMPTY: &str = r#"{"return": {}}"#;

    /// Greets, then answers each message by the next text; returns what it was
    /// told.
    fn server(
        folder: &Path,
        greeting: &'static str,
        answers: &'static [&'static str],
    ) -> JoinHandle<Vec<Value>> {
        let listener = UnixListener::bind(folder.join("qmp")).expect("binds");
        thread::spawn(move || {
            let (mut stream, _) = listener.accept().expect("a client");
            let mut lines = BufReader::new(stream.try_clone().expect("clones")).lines();
            writeln!(stream, "{greeting}").expect("writes");
            let mut told = Vec::new();
            for answer in answers {
                let line = lines.next().expect("a message").expect("reads");
                told.push(serde_json::from_str(&line).expect("JSON"));
                writeln!(stream, "{answer}").expect("writes");
            }
            told
        })
    }

    #[test]
    fn a_screendump_is_asked_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let server = server(folder.path(), GREETING, &[EMPTY, EMPTY]);
        let mut qmp = Qmp::connect(&folder.path().join("qmp")).expect("connects");
        qmp.screendump(Path::new("/a/b.ppm")).expect("answered");
        let told = server.join().expect("served");
        assert_eq!(told[0]["execute"], "qmp_capabilities");
        assert_eq!(
            told[1],
            json!({ "execute": "screendump", "arguments": { "filename": "/a/b.ppm" } })
        );
    }

    #[test]
    fn events_are_skipped_and_values_returned() {
        let folder = tempfile::tempdir().expect("a folder");
        let answers = &[EMPTY, "{\"event\": \"RESUME\"}\n{\"return\": 5}"];
        let server = server(folder.path(), GREETING, answers);
        let mut qmp = Qmp::connect(&folder.path().join("qmp")).expect("connects");
        assert_eq!(qmp.execute("query", &json!({})), Ok(json!(5)));
        server.join().expect("served");
    }

    #[test]
    fn refusals_carry_their_reason() {
        let folder = tempfile::tempdir().expect("a folder");
        let answers = &[
            EMPTY,
            r#"{"error": {"class": "X", "desc": "no such screen"}}"#,
        ];
        let server = server(folder.path(), GREETING, answers);
        let mut qmp = Qmp::connect(&folder.path().join("qmp")).expect("connects");
        let error = qmp.screendump(Path::new("x")).expect_err("refused");
        assert_eq!(error.what, "QMP: screendump failed: no such screen");
        server.join().expect("served");
        let error = qmp.execute("more", &json!({})).expect_err("closed");
        assert!(error.what.starts_with("QMP:"), "{error}");
    }

    #[test]
    fn others_are_not_taken_for_qemu() {
        for greeting in [EMPTY, "SSH-2.0"] {
            let folder = tempfile::tempdir().expect("a folder");
            let socket = folder.path().join("qmp");
            assert!(Qmp::connect(&socket).is_err(), "nobody there");
            let server = server(folder.path(), greeting, &[]);
            assert!(Qmp::connect(&socket).is_err(), "{greeting}");
            server.join().expect("served");
        }
    }
}
