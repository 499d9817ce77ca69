//! Whether pixels lie in the shadow that should.

use super::{SizeMismatch, check_sizes};
use crate::picture::Picture;
use crate::reference::Reference;

/// Mean cosine from which on a pixel's state shows in its colour.
const LEAST_LAMBERT: f32 = 0.06;
/// What may be missing to all or nothing of a pixel's light: rounding.
const WHOLE: f32 = 0.01;

/// The share of drawn pixels whose shadow state is wrong, of those farther than
/// `radius` pixels from any edge of a shadow: they are shadowed though all of
/// their light arrives (acne), or lit though none does (leaks). `lit` is the
/// picture without shadows: a pixel is shadowed where the two differ. Pixels
/// that hardly face the light count as right. 0 where nothing is drawn.
///
/// # Errors
/// When sizes differ.
pub fn shadow_errors(
    shadowed: &Picture,
    lit: &Picture,
    reference: &Reference,
    radius: f64,
) -> Result<f64, SizeMismatch> {
    check_sizes(shadowed, [reference.width, reference.height])?;
    check_sizes(lit, [reference.width, reference.height])?;
    let (width, height) = (reference.width as usize, reference.height as usize);
    let edges = edges(reference, width);
    let reach = radius.ceil() as usize;
    let is_near_edge = |at: usize| {
        let (x, y) = (at % width, at / width);
        let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
        rows.into_iter().any(|row| {
            let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
            columns.into_iter().any(|column| {
                let apart = [row.abs_diff(y), column.abs_diff(x)].map(|side| side as f64);
                edges[row * width + column] && apart[0].hypot(apart[1]) <= radius
            })
        })
    };
    let drawn = || (0..width * height).filter(|&at| lit.drawn[at] && reference.coverage[at] > 0.0);
    let is_wrong = |&at: &usize| {
        let state = match reference.shadow[at] {
            share if share <= WHOLE => false,
            share if share >= 1.0 - WHOLE => true,
            _ => return false,
        };
        reference.lambert[at] >= LEAST_LAMBERT
            && state != (shadowed.rgb[at] != lit.rgb[at])
            && !is_near_edge(at)
    };
    let wrong = drawn().filter(is_wrong).count();
    Ok(wrong as f64 / drawn().count().max(1) as f64)
}

/// Pixels that an edge of a shadow runs through or along.
fn edges(reference: &Reference, width: usize) -> Vec<bool> {
    let faces = |at: usize| reference.lambert[at] > 0.0;
    let is_mixed = |at: usize| (WHOLE..=1.0 - WHOLE).contains(&reference.shadow[at]);
    let differs = |a: usize, b: usize| {
        faces(a) && faces(b) && (reference.shadow[a] > 0.5) != (reference.shadow[b] > 0.5)
    };
    let mut edges: Vec<bool> = (0..reference.shadow.len()).map(is_mixed).collect();
    for at in 0..edges.len() {
        let right = (at % width + 1 < width).then_some(at + 1);
        let below = Some(at + width).filter(|&below| below < edges.len());
        for other in [right, below].into_iter().flatten() {
            if differs(at, other) {
                (edges[at], edges[other]) = (true, true);
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: u32 = 20;

    /// A lit plane, shadowed from a column on.
    fn plane(from: usize) -> (Picture, Reference) {
        let count = (SIDE * SIDE) as usize;
        let picture = Picture {
            width: SIDE,
            height: SIDE,
            rgb: vec![[200; 3]; count],
            drawn: vec![true; count],
        };
        let reference = Reference {
            width: SIDE,
            height: SIDE,
            colour: vec![[200; 3]; count],
            coverage: vec![1.0; count],
            nearest: vec![1.0; count],
            farthest: vec![1.0; count],
            lambert: vec![0.8; count],
            shadow: (0..count)
                .map(|at| f32::from(u8::from(at % SIDE as usize >= from)))
                .collect(),
        };
        (picture, reference)
    }

    fn with_shadow(lit: &Picture, is_shadowed: impl Fn(usize, usize) -> bool) -> Picture {
        let mut picture = lit.clone();
        for (at, pixel) in picture.rgb.iter_mut().enumerate() {
            if is_shadowed(at % SIDE as usize, at / SIDE as usize) {
                *pixel = [40; 3];
            }
        }
        picture
    }

    fn errors(is_shadowed: impl Fn(usize, usize) -> bool, radius: f64) -> f64 {
        let (lit, reference) = plane(10);
        let shadowed = with_shadow(&lit, is_shadowed);
        shadow_errors(&shadowed, &lit, &reference, radius).expect("of one size")
    }

    #[test]
    fn the_true_shadow_has_no_errors() {
        assert_eq!(errors(|x, _| x >= 10, 0.0), 0.0);
    }

    #[test]
    fn acne_and_leaks_count() {
        assert_eq!(errors(|x, y| x >= 10 || (x, y) == (3, 3), 2.0), 1.0 / 400.0);
        assert_eq!(
            errors(|x, y| x >= 10 && (x, y) != (15, 3), 2.0),
            1.0 / 400.0
        );
        assert_eq!(errors(|_, _| false, 0.0), 180.0 / 400.0);
    }

    #[test]
    fn near_edges_nothing_counts() {
        // Columns 9 and 10 are the edge.
        for (from, radius, wrong) in [(8, 1.0, 0.0), (7, 1.0, 20.0), (7, 2.0, 0.0), (13, 2.0, 0.0)]
        {
            assert_eq!(
                errors(|x, _| x >= from, radius),
                wrong / 400.0,
                "{from}, {radius}"
            );
        }
    }

    #[test]
    fn what_hardly_faces_the_light_is_right() {
        let (lit, mut reference) = plane(10);
        reference.lambert.fill(0.05);
        let got = shadow_errors(&lit, &lit, &reference, 0.0).expect("of one size");
        assert_eq!(got, 0.0);
    }
}
