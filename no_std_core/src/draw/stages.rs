//! Stages that the compiler would merge with the draw call. As functions of
//! their own they can be told apart in a profile of an optimised build, which
//! costs a few dozen instructions a strip.

use super::Light;
use crate::canvas::{Canvas, Pixel};
use crate::plan::Plan;
use crate::shade::{Paint, Shader};
use crate::target::{Picture, Rect};

/// The colours of a frame.
#[inline(never)]
pub(super) fn shade<'a>(light: &Light, paint: Paint<'a>, memory: &'a mut [u16]) -> Shader<'a> {
    Shader::new(light, paint, memory)
}

/// A clear canvas for a strip.
#[inline(never)]
pub(super) fn clear<P: Pixel>(words: &mut [u32], strip: Rect) -> Canvas<'_, P> {
    Canvas::new(words, strip)
}

/// A strip's pixels from its canvas.
#[inline(never)]
pub(super) fn resolve<P: Pixel>(
    canvas: &Canvas<'_, P>,
    strip: Rect,
    plan: &Plan,
    shader: &Shader<'_>,
    picture: &mut Picture<'_>,
) {
    crate::resolve::resolve(canvas, strip, plan.repair, shader, picture);
}
