//! What callgrind writes, as instructions by stage.
//!
//! A profile says which functions called which, and what that cost with all
//! that they called. From the measured function on, calls are followed as far
//! as functions that begin stages: the calls of those are the stages. So what
//! a stage calls is part of it, be it another stage's function.

use std::collections::{HashMap, HashSet};

use rhogrid_targets::stages::{Stage, StageInstructions};

/// All calls from one function to another.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Call<'a> {
    caller: &'a str,
    callee: &'a str,
    /// With what was called below.
    instructions: u64,
}

/// A profile, as far as it matters here.
#[derive(Debug)]
pub struct Profile<'a> {
    total: u64,
    calls: Vec<Call<'a>>,
}

/// Why a profile does not tell the stages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProfileError {
    /// A line, from 1, is not what callgrind writes.
    Line(usize),
    /// The sum of all instructions is missing.
    NoTotal,
    /// This function took other than all instructions.
    Total {
        /// The measured function.
        measured: u64,
        /// All.
        total: u64,
    },
    /// No function was called that begins this stage.
    Absent(Stage),
    /// The stages took more than the whole.
    Sum,
}

impl<'a> Profile<'a> {
    /// Reads a profile with uncompressed names and positions.
    ///
    /// # Errors
    /// When it is none.
    pub fn read(text: &'a str) -> Result<Self, ProfileError> {
        let (mut caller, mut callee) = (None, None);
        let (mut total, mut calls) = (None, Vec::new());
        let mut lines = text.lines().enumerate();
        while let Some((index, line)) = lines.next() {
            let bad = || ProfileError::Line(index + 1);
            if let Some(name) = line.strip_prefix("fn=") {
                caller = Some(name);
            } else if let Some(name) = line.strip_prefix("cfn=") {
                callee = Some(name);
            } else if line.starts_with("calls=") {
                // The next line: position, instructions.
                let cost = lines.next().and_then(|(_, cost)| cost.split_once(' '));
                let instructions = cost.and_then(|(_, count)| count.trim().parse().ok());
                calls.push(Call {
                    caller: caller.ok_or_else(bad)?,
                    callee: callee.take().ok_or_else(bad)?,
                    instructions: instructions.ok_or_else(bad)?,
                });
            } else if let Some(count) = line.strip_prefix("totals:") {
                total = Some(count.trim().parse().map_err(|_| bad())?);
            }
        }
        let total = total.ok_or(ProfileError::NoTotal)?;
        Ok(Self { total, calls })
    }

    /// Instructions of every stage of a measured function, which must be all
    /// that the profile has.
    ///
    /// # Errors
    /// When they do not add up, or a stage is absent.
    pub fn stages(&self, measured: &str) -> Result<StageInstructions, ProfileError> {
        let total = self.total;
        let whole = self.calls.iter().filter(|call| call.callee == measured);
        let measured_total = whole.map(|call| call.instructions).sum();
        if measured_total != total {
            let measured = measured_total;
            return Err(ProfileError::Total { measured, total });
        }
        let mut stages = [0; Stage::ALL.len()];
        let mut is_present = [false; Stage::ALL.len()];
        for (stage, instructions) in self.stage_calls(measured) {
            stages[stage as usize] += instructions;
            is_present[stage as usize] = true;
        }
        // Set-up is what remains.
        is_present[Stage::SetUp as usize] = true;
        for stage in Stage::ALL {
            if !is_present[stage as usize] {
                return Err(ProfileError::Absent(stage));
            }
        }
        let others: u64 = stages.iter().sum();
        stages[Stage::SetUp as usize] = total.checked_sub(others).ok_or(ProfileError::Sum)?;
        Ok(StageInstructions(stages))
    }

    /// The calls by which stages begin.
    fn stage_calls(&self, measured: &'a str) -> Vec<(Stage, u64)> {
        let mut by_caller = HashMap::<_, Vec<_>>::new();
        for call in &self.calls {
            by_caller.entry(call.caller).or_default().push(call);
        }
        let mut found = Vec::new();
        let mut seen = HashSet::from([measured]);
        let mut open = vec![measured];
        while let Some(caller) = open.pop() {
            for call in by_caller.get(caller).into_iter().flatten() {
                match Stage::begun_by(without_recursion(call.callee)) {
                    Some(stage) => found.push((stage, call.instructions)),
                    None if seen.insert(call.callee) => open.push(call.callee),
                    None => {}
                }
            }
        }
        found
    }
}

/// A name without the number of the recursion: `node'2`.
fn without_recursion(name: &str) -> &str {
    match name.rsplit_once('\'') {
        Some((plain, depth)) if depth.bytes().all(|byte| byte.is_ascii_digit()) => plain,
        _ => name,
    }
}

#[cfg(test)]
mod tests;
