//! The lines that firmware prints, understood and checked. `rhogrid-measure`
//! says what they are.

use rhogrid::error::Error;

use crate::clock::Clock;
use crate::failure;

/// Version of the lines that this module understands.
const PROTOCOL: u32 = 1;

/// Instructions of one loop of the firmware's `spin`.
const SPIN_INSTRUCTIONS: u64 = 2;

/// One line.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Line {
    Hello { protocol: u32, views: usize },
    Read { start: u32, end: u32 },
    Spin { loops: u32, start: u32, end: u32 },
    View(Reading),
    Shown { width: u32, height: u32 },
    Done,
    Error(String),
}

/// What a `VIEW` line says.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Reading {
    index: usize,
    start: u32,
    end: u32,
    frame_hash: u32,
    stack_bytes: u32,
}

/// One view as the machine saw it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewResult {
    /// Instructions of the draw call.
    pub instructions: u64,
    /// The same and what reading the timer takes.
    pub between_readings: u64,
    /// Hash of the picture.
    pub frame_hash: u32,
    /// Stack below the caller's frame.
    pub stack_bytes: u32,
}

/// What a machine still has to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It has left.
    Done,
    /// It shows the last picture, this wide and high.
    Shown {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
}

/// A conversation with firmware: takes its lines one by one.
#[derive(Debug)]
pub struct Session {
    clock: Clock,
    views: usize,
    greeted: bool,
    /// Instructions of reading the timer.
    reading: Option<u64>,
    /// Instructions around a spin's loops.
    around_spin: Option<u64>,
    next_view: usize,
}

/// What a line meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The firmware has said who it is.
    Greeting,
    /// The timer was checked.
    Check {
        /// Instructions between two readings of it.
        between_readings: u64,
    },
    /// A view is measured.
    View(ViewResult),
    /// All views are.
    End(Ending),
}

impl Session {
    /// A conversation about this many views.
    pub fn new(clock: Clock, views: usize) -> Self {
        Self {
            clock,
            views,
            greeted: false,
            reading: None,
            around_spin: None,
            next_view: 0,
        }
    }

    /// Instructions that reading the timer takes; subtracted from every view.
    pub fn reading_cost(&self) -> Option<u64> {
        self.reading
    }

    /// Takes the next line.
    ///
    /// # Errors
    /// When the firmware reports an error, says what it should not, or its
    /// timer does not count instructions.
    pub fn take(&mut self, text: &str) -> Result<Event, Error> {
        let unexpected = || {
            let what = format!("the firmware printed an unexpected line: {text:?}");
            failure(
                what,
                "the firmware must be of the same commit as the runner",
            )
        };
        let line = parse(text).ok_or_else(unexpected)?;
        match line {
            Line::Error(what) => Err(failure(format!("the firmware failed: {what}"), "")),
            Line::Hello { protocol, views }
                if !self.greeted && protocol == PROTOCOL && views == self.views =>
            {
                self.greeted = true;
                Ok(Event::Greeting)
            }
            _ if !self.greeted => Err(unexpected()),
            Line::Read { start, end } => {
                let between_readings = self.instructions(start, end)?;
                self.reading = Some(between_readings);
                Ok(Event::Check { between_readings })
            }
            Line::Spin { loops, start, end } => self.check_spin(loops, start, end),
            Line::View(reading) if reading.index == self.next_view => {
                self.next_view += 1;
                self.view(&reading).map(Event::View)
            }
            Line::Shown { width, height } if self.next_view == self.views => {
                Ok(Event::End(Ending::Shown { width, height }))
            }
            Line::Done if self.next_view == self.views => Ok(Event::End(Ending::Done)),
            _ => Err(unexpected()),
        }
    }

    /// Known numbers of instructions must come out exactly: all loops cost the
    /// same beside `SPIN_INSTRUCTIONS` for each round.
    fn check_spin(&mut self, loops: u32, start: u32, end: u32) -> Result<Event, Error> {
        let loop_instructions = SPIN_INSTRUCTIONS * u64::from(loops);
        let between_readings = self.instructions(start, end)?;
        let around = between_readings
            .checked_sub(loop_instructions)
            .ok_or_else(not_counting)?;
        if *self.around_spin.get_or_insert(around) != around {
            return Err(not_counting());
        }
        Ok(Event::Check { between_readings })
    }

    fn view(&self, reading: &Reading) -> Result<ViewResult, Error> {
        let between_readings = self.instructions(reading.start, reading.end)?;
        let reading_cost = self.reading.ok_or_else(not_counting)?;
        if self.around_spin.is_none() {
            return Err(not_counting());
        }
        Ok(ViewResult {
            instructions: between_readings
                .checked_sub(reading_cost)
                .ok_or_else(not_counting)?,
            between_readings,
            frame_hash: reading.frame_hash,
            stack_bytes: reading.stack_bytes,
        })
    }

    fn instructions(&self, start: u32, end: u32) -> Result<u64, Error> {
        self.clock.instructions(start, end).ok_or_else(not_counting)
    }
}

fn not_counting() -> Error {
    failure(
        "the machine's timer does not count instructions",
        "this QEMU's -icount or its timer differs from version 7.2's; use that one",
    )
}

fn parse(text: &str) -> Option<Line> {
    let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
    if word == "ERROR" {
        return Some(Line::Error(rest.to_owned()));
    }
    let fields: Vec<&str> = rest.split_whitespace().collect();
    let number = |field: &str| field.parse::<u32>().ok();
    Some(match (word, fields.as_slice()) {
        ("RHOGRID", [protocol, views]) => Line::Hello {
            protocol: number(protocol)?,
            views: views.parse().ok()?,
        },
        ("READ", [start, end]) => Line::Read {
            start: number(start)?,
            end: number(end)?,
        },
        ("SPIN", [loops, start, end]) => Line::Spin {
            loops: number(loops)?,
            start: number(start)?,
            end: number(end)?,
        },
        ("VIEW", [index, start, end, hash, stack]) => Line::View(Reading {
            index: index.parse().ok()?,
            start: number(start)?,
            end: number(end)?,
            frame_hash: u32::from_str_radix(hash, 16).ok()?,
            stack_bytes: number(stack)?,
        }),
        ("SHOWN", [width, height]) => Line::Shown {
            width: number(width)?,
            height: number(height)?,
        },
        ("DONE", []) => Line::Done,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOCK: Clock = Clock {
        icount_shift: 10,
        tick_ns: 1000,
    };

    fn events(lines: &[&str], views: usize) -> Result<Vec<Event>, Error> {
        let mut session = Session::new(CLOCK, views);
        lines.iter().map(|line| session.take(line)).collect()
    }

    #[test]
    fn a_whole_session() {
        let lines = [
            "RHOGRID 1 1",
            "READ 4 10",
            "SPIN 1 4 15",
            "SPIN 1000 4 2061",
            "VIEW 0 4 1702511 302f2217 112",
            "SHOWN 240 320",
        ];
        let events = events(&lines, 1).expect("all is well");
        let view = ViewResult {
            // floor(1702511 / 1.024) - floor(4 / 1.024) - 6.
            instructions: 1_662_608 - 3 - 6,
            between_readings: 1_662_608 - 3,
            frame_hash: 0x302f_2217,
            stack_bytes: 112,
        };
        assert_eq!(events[4], Event::View(view));
        let shown = Ending::Shown {
            width: 240,
            height: 320,
        };
        assert_eq!(events[5], Event::End(shown));
        let checks = [6, 11, 2009].map(|between_readings| Event::Check { between_readings });
        assert_eq!(events[0], Event::Greeting);
        assert_eq!(events[1..4], checks);
    }

    #[test]
    fn a_timer_that_does_not_count_instructions_is_noticed() {
        let lines = [
            "RHOGRID 1 1",
            "READ 4 10",
            "SPIN 1 4 15",
            "SPIN 1000 4 2062",
        ];
        let error = events(&lines, 1).expect_err("one tick too many");
        assert!(
            error.what.contains("does not count instructions"),
            "{error}"
        );
        let lines = ["RHOGRID 1 1", "READ 4 10", "VIEW 0 4 5 0 0"];
        assert!(
            events(&lines, 1).is_err(),
            "a view before the timer's check"
        );
    }

    #[test]
    fn errors_of_the_firmware_are_passed_on() {
        let error = events(&["ERROR Frame(Magic)"], 1).expect_err("an error");
        assert_eq!(error.what, "the firmware failed: Frame(Magic)");
    }

    #[test]
    fn lines_out_of_place_are_errors() {
        for lines in [
            &["VIEW 0 4 1702511 302f2217 112"][..],
            &["RHOGRID 2 1"],
            &["RHOGRID 1 2"],
            &["RHOGRID 1 1", "DONE"],
            &["RHOGRID 1 1", "RHOGRID 1 1"],
            &["RHOGRID 1 1", "VIEW 1 4 5 0 0"],
            &["RHOGRID 1 1", "READ 4"],
            &["RHOGRID 1 1", "hello"],
            &[""],
        ] {
            let error = events(lines, 1).expect_err("out of place");
            assert!(error.what.contains("unexpected line"), "{error}");
        }
    }
}
