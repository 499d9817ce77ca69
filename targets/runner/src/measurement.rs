//! One view's result, for people and for programs.

use serde::{Serialize, Serializer};

use crate::cycles::CLOCK_MHZ;
use crate::stages::StageInstructions;

/// What was measured for one view.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Measurement {
    /// Name of the machine.
    pub machine: String,
    /// Name of the view.
    pub view: String,
    /// Instructions of the draw call.
    pub instructions: u64,
    /// Cycles, estimated by [`crate::cycles`]; `None` without its counts.
    pub cycles_estimate: Option<u64>,
    /// Hash of the machine's picture.
    #[serde(serialize_with = "hex")]
    pub frame_hash: u32,
    /// Hash of the host's picture.
    #[serde(serialize_with = "hex")]
    pub host_frame_hash: u32,
    /// Stack that the draw call used below its caller's frame.
    pub stack_bytes: u32,
    /// Instructions of each stage, where they are asked for.
    #[serde(skip)]
    pub stages: Option<StageInstructions>,
}

fn hex<S: Serializer>(hash: &u32, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&format_args!("{hash:08x}"))
}

impl Measurement {
    /// Whether machine and host drew the same picture.
    pub fn agrees(&self) -> bool {
        self.frame_hash == self.host_frame_hash
    }

    /// A line for people.
    pub fn line(&self) -> String {
        let agreement = if self.agrees() {
            "= host".to_owned()
        } else {
            format!("DIFFERS from the host's {:08x}", self.host_frame_hash)
        };
        let cycles = self.cycles_estimate.map_or_else(String::new, |cycles| {
            format!(
                "  ~{:.1} M cycles ({} ms at {CLOCK_MHZ} MHz)",
                cycles as f64 / 1e6,
                (cycles + CLOCK_MHZ * 500) / (CLOCK_MHZ * 1000)
            )
        });
        format!(
            "{} {:<9} {:>11} instructions{cycles}  {:>6} bytes of stack  frame {:08x} {agreement}",
            self.machine, self.view, self.instructions, self.stack_bytes, self.frame_hash
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measurement() -> Measurement {
        Measurement {
            machine: "sa1110".to_owned(),
            view: "full/90".to_owned(),
            instructions: 1_662_612,
            cycles_estimate: None,
            frame_hash: 0x00ab_cdef,
            host_frame_hash: 0x00ab_cdef,
            stack_bytes: 112,
            stages: None,
        }
    }

    #[test]
    fn json_has_stable_keys_and_eight_digits() {
        let json = serde_json::to_string(&measurement()).expect("serialises");
        let expected = concat!(
            r#"{"machine":"sa1110","view":"full/90","instructions":1662612,"#,
            r#""cycles_estimate":null,"frame_hash":"00abcdef","#,
            r#""host_frame_hash":"00abcdef","stack_bytes":112}"#
        );
        assert_eq!(json, expected);
    }

    #[test]
    fn an_estimate_is_a_number_and_is_marked_as_one_for_people() {
        let mut measurement = measurement();
        assert!(!measurement.line().contains("cycles"));
        measurement.cycles_estimate = Some(3_750_123);
        let line = measurement.line();
        assert!(
            line.contains("  ~3.8 M cycles (18 ms at 206 MHz)  "),
            "{line}"
        );
        let json = serde_json::to_string(&measurement).expect("serialises");
        assert!(json.contains(r#""cycles_estimate":3750123,"#), "{json}");
    }

    #[test]
    fn a_difference_is_in_the_line() {
        let mut measurement = measurement();
        assert!(measurement.line().ends_with("frame 00abcdef = host"));
        measurement.host_frame_hash = 1;
        assert!(!measurement.agrees());
        assert!(
            measurement
                .line()
                .ends_with("DIFFERS from the host's 00000001")
        );
    }
}
