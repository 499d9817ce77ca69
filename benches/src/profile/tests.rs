//! Profiles written by hand.

use super::*;

/// Main calls the measured function; a stage calls the function of another
/// stage, itself and, as set-up does, `memset`.
const PROFILE: &str = "\
# callgrind format
events: Ir
summary: 1000

fl=main.rs
fn=main
cfn=measured
calls=1 29 
360 1000

fn=measured
59 3
cfn=rhogrid_core::draw::stages::shade
calls=1 71 
67 100
cfn=rhogrid_core::draw::stages::clear
calls=1 71 
67 20
cfn=run
calls=1 71 
68 400
cfn=rhogrid_core::draw::stages::resolve
calls=2 71 
70 300

fn=rhogrid_core::draw::stages::clear
3 20

fn=run
4 40
cfn=memset
calls=1 1 
4 10
cfn=rhogrid_core::grid::traverse::Frame<_,_>::node
calls=1 71 
5 350

fn=memset
1 15

fn=rhogrid_core::grid::traverse::Frame<_,_>::node
6 200
cfn=rhogrid_core::grid::traverse::Frame<_,_>::node'2
calls=3 71 
7 145
cfn=memset
calls=1 1 
8 5

fn=rhogrid_core::draw::stages::resolve
cfn=rhogrid_core::draw::stages::clear
calls=9 1 
8 30

totals: 1000
";

fn stages(profile: &str) -> Result<[u64; 5], ProfileError> {
    let stages = Profile::read(profile)?.stages("measured")?;
    Ok(stages.0)
}

#[test]
fn stages_are_the_outermost_calls_of_their_functions() {
    // Set-up is what remains; no recursion counts twice.
    let expected = [1000 - 100 - 20 - 350 - 300, 100, 20, 350, 300];
    assert_eq!(stages(PROFILE), Ok(expected));
}

#[test]
fn a_stage_that_was_not_called_is_named() {
    let inlined = PROFILE.replace("Frame<_,_>::node", "Frame<_,_>::inner");
    let absent = ProfileError::Absent(Stage::Traversal);
    assert_eq!(stages(&inlined), Err(absent));
}

#[test]
fn instructions_outside_of_the_measured_function_are_an_error() {
    let more = PROFILE.replace("totals: 1000", "totals: 1001");
    let (measured, total) = (1000, 1001);
    let error = ProfileError::Total { measured, total };
    assert_eq!(stages(&more), Err(error));
    let other = PROFILE.replace("cfn=measured", "cfn=warm_up");
    let (measured, total) = (0, 1000);
    assert_eq!(stages(&other), Err(ProfileError::Total { measured, total }));
}

#[test]
fn stages_that_take_more_than_the_whole_are_an_error() {
    let more = PROFILE.replace("70 300", "70 800");
    assert_eq!(stages(&more), Err(ProfileError::Sum));
}

#[test]
fn what_callgrind_does_not_write_is_an_error() {
    for (line, wrong) in [
        ("360 1000", "360"),
        ("360 1000", "360 x"),
        ("cfn=measured", ""),
    ] {
        let error = stages(&PROFILE.replacen(line, wrong, 1));
        assert_eq!(error, Err(ProfileError::Line(8)), "{wrong}");
    }
    let cut = PROFILE.split("totals").next().unwrap_or_default();
    assert_eq!(stages(cut), Err(ProfileError::NoTotal));
    assert_eq!(stages(""), Err(ProfileError::NoTotal));
}

#[test]
fn names_lose_their_recursion_alone() {
    assert_eq!(without_recursion("node'2"), "node");
    assert_eq!(without_recursion("node"), "node");
    assert_eq!(without_recursion("lifetime<'a>"), "lifetime<'a>");
}
