use super::*;
use crate::asset::node::{APERTURE_COSINE, APERTURE_SINE};
use crate::grid::normals::{Around, Normals};
use crate::normal::CODES;
use crate::testing::{Rng, direction, dot};

fn axis(code: u16) -> [f64; 3] {
    let axis = decode(code).map(f64::from);
    let length = dot(axis, axis).sqrt();
    axis.map(|c| c / length)
}

fn view(rng: &mut Rng) -> [i32; 3] {
    let length = 32768.0 * rng.f64();
    direction(rng).map(|c| (c * length) as i32)
}

/// The least n . (v + d) over all normals n within an angle of the axis and
/// all |d| <= radius.
fn least(code: u16, angle: f64, view: [f64; 3], radius: f64) -> f64 {
    let length = dot(view, view).sqrt();
    let off_axis = (dot(axis(code), view) / length).clamp(-1.0, 1.0).acos();
    length * (off_axis + angle).min(core::f64::consts::PI).cos() - radius
}

fn angle(aperture: u8) -> f64 {
    (6.0 * (f64::from(aperture) + 1.0)).to_radians()
}

#[test]
fn aperture_tables_are_rounded_sines_and_cosines() {
    for aperture in 0..15u8 {
        let exact = angle(aperture);
        let sine = f64::from(APERTURE_SINE[usize::from(aperture)]) / 32768.0;
        let cosine = f64::from(APERTURE_COSINE[usize::from(aperture)]) / 32768.0;
        // Up and down: a cone never closes; 90 degrees are exact.
        let sine_off = (sine - exact.sin()) * 32768.0;
        let cosine_off = (exact.cos() - cosine) * 32768.0;
        assert!((-1e-9..=1.0 + 1e-9).contains(&sine_off), "sine {aperture}");
        assert!(
            (-1e-9..=1.0 + 1e-9).contains(&cosine_off),
            "cosine {aperture}"
        );
    }
}

#[test]
fn along_is_within_its_bound() {
    let mut rng = Rng::with_seed(11);
    for _ in 0..1_000_000 {
        let (code, view) = (rng.u16(..CODES as u16), view(&mut rng));
        let exact = dot(axis(code), view.map(f64::from));
        let error = f64::from(along(code, view)) - exact;
        assert!(error.abs() < 4.0, "code {code}, view {view:?}: {error}");
    }
}

#[test]
fn cones_turn_away_only_where_every_normal_does() {
    let mut rng = Rng::with_seed(12);
    let (mut away, mut clear, mut found) = (0, 0, 0);
    for _ in 0..1_000_000 {
        let flags = Flags {
            aperture: rng.u8(..15),
            two_sided: false,
        };
        let (code, view) = (rng.u16(..CODES as u16), view(&mut rng));
        let radius = (32768.0 * rng.f64().powi(4)) as i32;
        let float_view = view.map(f64::from);
        let exact = least(code, angle(flags.aperture), float_view, f64::from(radius));
        let length = dot(float_view, float_view).sqrt();
        let got = cone(flags, code, view, radius);
        if got == Facing::Away {
            away += 1;
            assert!(exact > 0.0, "{flags:?} {code} {view:?} {radius}: {exact}");
        }
        if exact > 0.02 * length {
            clear += 1;
            found += u32::from(got == Facing::Away);
        }
    }
    let share = f64::from(found) / f64::from(clear);
    std::println!("cones: {away} away, {share:.4} of {clear} clear ones found");
    assert!(clear > 50_000 && share > 0.9, "{share} of {clear}");
}

#[test]
fn open_cones_never_turn_away() {
    let code = crate::normal::encode([0, 0, 1 << 20]);
    let view = [0, 0, 20000];
    for aperture in 0..16 {
        for two_sided in [false, true] {
            let flags = Flags {
                aperture,
                two_sided,
            };
            let want = if aperture >= 14 {
                Facing::Maybe
            } else {
                Facing::Away
            };
            assert_eq!(cone(flags, code, view, 0), want, "{flags:?}");
            let ahead = cone(flags, code, view.map(|c| -c), 0);
            let want = if aperture >= 14 {
                Facing::Maybe
            } else {
                Facing::Toward
            };
            assert_eq!(ahead, want, "{flags:?}");
        }
    }
}

/// How often one of two tests turned away, and how often it could have.
#[derive(Default)]
struct Found {
    clear: u32,
    found: u32,
}

impl Found {
    /// Holds one answer against the exact least component.
    fn hold(&mut self, is_away: bool, least: f64, length: f64, case: &dyn core::fmt::Debug) {
        assert!(!is_away || least > 0.0, "{case:?}: {least}");
        if least > 0.2 * length {
            self.clear += 1;
            self.found += u32::from(is_away);
        }
    }

    fn share(&self) -> f64 {
        f64::from(self.found) / f64::from(self.clear)
    }
}

#[test]
fn quick_tests_turn_away_only_where_every_normal_does() {
    let mut rng = Rng::with_seed(13);
    let (mut alone, mut shared) = (Found::default(), Found::default());
    for _ in 0..1_000_000 {
        let flags = Flags {
            aperture: rng.u8(..15),
            two_sided: false,
        };
        let (code, view) = (rng.u16(..CODES as u16), view(&mut rng));
        let length = |v: [f64; 3]| dot(v, v).sqrt();
        let float = |v: [i32; 3]| v.map(f64::from);
        let size = length(float(view));
        // A cell within `around` of the view vector's end.
        let around = (size * rng.f64() * 0.7) as i32;
        let radius = (f64::from(around) * rng.f64()) as i32;
        let offset = direction(&mut rng).map(|c| c * f64::from(around - radius));
        let child = [0, 1, 2].map(|axis| view[axis] + offset[axis] as i32);
        let exact = |view: [i32; 3]| {
            let least = least(code, angle(flags.aperture), float(view), f64::from(radius));
            (least, length(float(view)))
        };
        let case = (flags, code, view, child, around, radius);
        let (bound, distance) = exact(view);
        let is_away = Normals::new(view, radius).is_away(flags, code);
        alone.hold(is_away, bound, distance, &case);
        let (bound, distance) = exact(child);
        let is_away = Around::new(view, around, radius)
            .normals(child)
            .is_away(flags, code);
        shared.hold(is_away, bound, distance, &case);
    }
    let shares = [alone.share(), shared.share()];
    std::println!("quick cones: {shares:.4?} of {} found", alone.clear);
    assert!(alone.clear > 50_000 && shared.clear > 50_000);
    assert!(shares[0] > 0.9 && shares[1] > 0.4, "{shares:?}");
}
