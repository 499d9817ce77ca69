//! Proof by disassembly that an image runs on ARMv4, which has no BX, CLZ,
//! divide, LDRD, media or floating-point instruction and no Thumb.
//!
//! The disassembler is asked for ARMv7, so that it knows newer instructions by
//! name; then every mnemonic must be on the list of ARMv4's own. What is on no
//! list, or unknown to the disassembler, is refused.

/// Base mnemonics of ARMv4 that take `s` to set flags.
const FLAG_SETTING: [&str; 22] = [
    "adc", "add", "and", "asr", "bic", "eor", "lsl", "lsr", "mla", "mov", "mul", "mvn", "orr",
    "ror", "rrx", "rsb", "rsc", "sbc", "smlal", "smull", "sub", "umlal",
];

/// All other mnemonics of ARMv4, in today's spelling. Shifts are moves.
const OTHERS: [&str; 41] = [
    "umull", "umulls", "cmn", "cmp", "teq", "tst", "b", "bl", "svc", "mrs", "msr", "ldr", "ldrb",
    "ldrt", "ldrbt", "ldrh", "ldrsb", "ldrsh", "str", "strb", "strt", "strbt", "strh", "ldm",
    "ldmda", "ldmdb", "ldmib", "stm", "stmda", "stmdb", "stmib", "pop", "push", "swp", "swpb",
    "cdp", "ldc", "stc", "mcr", "mrc", "adr",
];

/// Words that are undefined on purpose, on ARMv4 as on all later ones: what the
/// compiler puts where execution cannot come.
const UNDEFINED: [&str; 2] = ["trap", "udf"];

/// Condition suffixes.
const CONDITIONS: [&str; 16] = [
    "eq", "ne", "hs", "cs", "lo", "cc", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le",
];

/// What a disassembly holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Finding {
    /// Instructions of ARMv4.
    pub instructions: usize,
    /// Lines with anything else.
    pub refused: Vec<String>,
}

/// Goes through the output of `llvm-objdump -d --no-show-raw-insn`.
pub fn examine(disassembly: &str) -> Finding {
    let mut finding = Finding::default();
    for line in disassembly.lines() {
        // `  10000:<blanks>\tmnemonic\toperands`; headings have no address.
        let mut fields = line.split('\t');
        let address = fields.next().unwrap_or("").trim();
        let Some(mnemonic) = fields.next().map(str::trim) else {
            continue;
        };
        if !is_address(address) || is_data(mnemonic) {
            continue;
        }
        if is_armv4(mnemonic) {
            finding.instructions += 1;
        } else {
            finding.refused.push(line.trim().to_owned());
        }
    }
    finding
}

/// Hexadecimal digits and a colon.
fn is_address(field: &str) -> bool {
    field
        .strip_suffix(':')
        .is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_hexdigit()))
}

/// Literals between instructions.
fn is_data(mnemonic: &str) -> bool {
    [".word", ".short", ".byte"].contains(&mnemonic)
}

fn is_armv4(mnemonic: &str) -> bool {
    let known = |base: &str| {
        OTHERS.contains(&base)
            || FLAG_SETTING.contains(&base)
            || base
                .strip_suffix('s')
                .is_some_and(|plain| FLAG_SETTING.contains(&plain))
    };
    UNDEFINED.contains(&mnemonic)
        || known(mnemonic)
        || CONDITIONS
            .iter()
            .any(|condition| mnemonic.strip_suffix(condition).is_some_and(known))
}

/// Whether a symbol list (`llvm-readobj --symbols`) marks Thumb code.
pub fn has_thumb(symbols: &str) -> bool {
    symbols.lines().any(|line| {
        let name = line.trim().strip_prefix("Name: $t");
        name.is_some_and(|rest| rest.starts_with([' ', '.']) || rest.is_empty())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLEAN: &str = concat!(
        "firmware:\tfile format elf32-littlearm\n",
        "\n",
        "00010000 <_start>:\n",
        "   10000:      \tmrs\tr0, apsr\n",
        "   10004:      \tstrlo\tr2, [r0], #4\n",
        "   10008:      \tblo\t0x10004 <_start+0x4>\n",
        "   1000c:      \tumull\tr0, r1, r2, r3\n",
        "   10010:      \trsbsmi\tr0, r0, #0\n",
        "   10014:      \tldmibne\tr0, {r1, r2}\n",
        "   10018:      \tbls\t0x10000 <_start>\n",
        "   1001c:      \tsvc\t#0x123456\n",
        "   1001e:      \ttrap\n",
        "   10020:      \t.word\t0x0000c5c5\n",
    );

    fn with(line: &str) -> Finding {
        examine(&format!("{CLEAN}   10024:      \t{line}\n"))
    }

    #[test]
    fn armv4_is_armv4() {
        let finding = examine(CLEAN);
        assert_eq!(finding.refused, [""; 0]);
        assert_eq!(finding.instructions, 9);
    }

    #[test]
    fn newer_instructions_are_refused_where_they_are() {
        for planted in [
            "clz\tr0, r1",
            "bx\tlr",
            "bxne\tlr",
            "blx\tr3",
            "ldrd\tr0, r1, [r2]",
            "strd\tr0, r1, [r2]",
            "movw\tr0, #1",
            "movt\tr0, #1",
            "mls\tr0, r1, r2, r3",
            "udiv\tr0, r1, r2",
            "sdivge\tr0, r1, r2",
            "smulbb\tr0, r1, r2",
            "smlalbb\tr0, r1, r2, r3",
            "umaal\tr0, r1, r2, r3",
            "qadd\tr0, r1, r2",
            "rev\tr0, r1",
            "uxtb\tr0, r1",
            "ubfx\tr0, r1, #2, #3",
            "pld\t[r0]",
            "ldrex\tr0, [r1]",
            "dmb\tsy",
            "nop",
            "bkpt\t#0",
            "vadd.f32\ts0, s1, s2",
            "mcrr\tp15, #0, r0, r1, c0",
            "mrc2\tp15, #0, r0, c0, c0, #0",
            "rfeia\tr0!",
            "cps\t#19",
            "<unknown>",
        ] {
            let finding = with(planted);
            assert_eq!(finding.refused, [format!("10024:      \t{planted}")]);
            assert_eq!(finding.instructions, 9, "{planted}");
        }
    }

    #[test]
    fn every_condition_and_flag_is_understood() {
        for condition in CONDITIONS {
            for base in ["b", "bl", "add", "adds", "ldrsh", "muls", "tst"] {
                let finding = with(&format!("{base}{condition}\tr0, r1"));
                assert_eq!(finding.refused, [""; 0], "{base}{condition}");
            }
            assert_eq!(with(&format!("clz{condition}\tr0, r1")).refused.len(), 1);
        }
    }

    #[test]
    fn thumb_symbols_are_seen() {
        assert!(!has_thumb(
            "  Name: $a (1)\n  Name: $d.3 (5)\n  Name: $table (9)\n"
        ));
        assert!(has_thumb("  Name: $a (1)\n  Name: $t (5)\n"));
        assert!(has_thumb("  Name: $t.12 (5)\n"));
    }
}
