//! Functions of an image, by name.

use std::path::Path;

use rhogrid::error::Error;
use rustc_demangle::demangle;

use crate::stages::Stage;
use crate::toolchain::llvm;

/// A function of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Where it begins.
    pub address: u64,
    /// Its symbol.
    pub symbol: String,
    /// The symbol as Rust writes it, without hashes.
    pub name: String,
}

/// Where a stage begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The stage.
    pub stage: Stage,
    /// Address of its function.
    pub address: u64,
}

/// The functions of an ELF image.
///
/// # Errors
/// When they cannot be listed.
pub fn functions(image: &Path) -> Result<Vec<Function>, Error> {
    let options = ["--defined-only", "--format=bsd"].map(Path::new);
    let listing = llvm("llvm-nm", &[options[0], options[1], image])?;
    Ok(listing.lines().filter_map(function).collect())
}

/// A line of `llvm-nm`: `address kind symbol`.
fn function(line: &str) -> Option<Function> {
    let mut fields = line.split_whitespace();
    let address = u64::from_str_radix(fields.next()?, 16).ok()?;
    let is_code = ["t", "T"].contains(&fields.next()?);
    let symbol = fields.next()?.to_owned();
    is_code.then(|| Function {
        address,
        name: name_of(&symbol),
        symbol,
    })
}

/// A symbol as Rust writes it, without hashes.
pub fn name_of(symbol: &str) -> String {
    format!("{:#}", demangle(symbol))
}

/// Where the stages of a frame begin in an image.
///
/// # Errors
/// When one of them begins nowhere.
pub fn stage_entries(image: &Path) -> Result<Vec<Entry>, Error> {
    entries(&functions(image)?).map_err(|stage| {
        let what = format!("no function begins the stage `{}`", stage.name());
        let remedy = "the compiler has inlined it, or it has another name; \
                      name it in targets/runner/src/stages.rs";
        Error::file(image, what, remedy)
    })
}

fn entries(functions: &[Function]) -> Result<Vec<Entry>, Stage> {
    let begun = |function: &Function| {
        let stage = Stage::begun_by(&function.name)?;
        let address = function.address;
        Some(Entry { stage, address })
    };
    let entries: Vec<Entry> = functions.iter().filter_map(begun).collect();
    // What begins nowhere on purpose is set-up.
    let is_absent = |stage: &Stage| entries.iter().all(|entry| entry.stage != *stage);
    match Stage::ALL.into_iter().skip(1).find(is_absent) {
        None => Ok(entries),
        Some(stage) => Err(stage),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHADE: &str = "_RNvNtNtCs5_12rhogrid_core4draw6stages5shade";
    const CLEAR: &str = "_RNvNtNtCs5_12rhogrid_core4draw6stages5clear";
    const NODE: &str =
        "_RINvMNtNtCs5_12rhogrid_core4grid8traverseINtB3_5FrameKj1b_Kj9_E4nodeKh3_EB7_";
    const RESOLVE: &str = "_RNvNtNtCs5_12rhogrid_core4draw6stages7resolve";

    fn listed(symbols: &[&str]) -> Vec<Function> {
        let line = |(index, symbol)| format!("{:08x} t {symbol}", 0x10000 + 4 * index);
        let lines: Vec<String> = symbols.iter().enumerate().map(line).collect();
        lines.iter().filter_map(|line| function(line)).collect()
    }

    #[test]
    fn functions_are_listed() {
        let clear = function(&format!("0001a2b8 t {CLEAR}")).expect("a function");
        assert_eq!(clear.address, 0x1a2b8);
        assert_eq!(clear.symbol, CLEAR);
        assert_eq!(clear.name, "rhogrid_core::draw::stages::clear");
        let node = "<rhogrid_core::grid::traverse::Frame<27, 9>>::node::<3>";
        assert_eq!(name_of(NODE), node);
        assert_eq!(name_of("_start"), "_start");
        for line in [
            "",
            "00010000",
            "         U _start",
            "00010000 d _start",
            "x t _start",
        ] {
            assert_eq!(function(line), None, "{line}");
        }
    }

    #[test]
    fn every_stage_begins_somewhere() {
        let functions = listed(&["_start", SHADE, CLEAR, NODE, RESOLVE, NODE]);
        let found = entries(&functions).expect("all of them");
        let found: Vec<_> = found
            .iter()
            .map(|entry| (entry.stage, entry.address))
            .collect();
        let expected = [
            (Stage::ShadeTable, 0x10004),
            (Stage::Clear, 0x10008),
            (Stage::Traversal, 0x1000c),
            (Stage::Resolve, 0x10010),
            (Stage::Traversal, 0x10014),
        ];
        assert_eq!(found, expected);
        assert_eq!(
            entries(&listed(&[SHADE, CLEAR, RESOLVE])),
            Err(Stage::Traversal)
        );
    }
}
