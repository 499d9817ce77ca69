//! What the golden frames show.

use glam::DVec3;
use rhogrid::geometry::{Geometry, Mesh};
use rhogrid::import::procedural::{demo, shapes};
use rhogrid_core::asset::Grid;
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};
use rhogrid_core::shadow::Method;
use rhogrid_core::target::Rect;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Model {
    Demo,
    Sphere,
    Cube,
    Torus,
    /// A torus whose colour is its place.
    Painted,
    Quad,
}

impl Model {
    pub fn geometry(self) -> Geometry {
        Geometry::Mesh(match self {
            Self::Demo => demo(),
            Self::Sphere => shapes::sphere(24),
            Self::Cube => shapes::cube(),
            Self::Torus => shapes::torus(48, 24),
            Self::Painted => painted(shapes::torus(48, 24)),
            Self::Quad => shapes::quad(),
        })
    }
}

/// With a colour for each corner, 0 to 255 from -1 to 1.
fn painted(mesh: Mesh) -> Mesh {
    let colour = |position: u32| {
        let place = mesh.positions[position as usize];
        let channels = ((place + 1.0) * 127.5).round();
        channels.to_array().map(|channel| channel as u8)
    };
    let corners = mesh.triangles.iter().map(|t| t.positions.map(colour));
    Mesh {
        colours: corners.collect(),
        ..mesh.clone()
    }
}

/// A view on an orbit. The focal length equals the height, as in the standard
/// views.
#[derive(Clone, Copy, Debug)]
pub struct View {
    pub yaw_degrees: u32,
    pub pitch_degrees: u32,
    /// In radii of the model.
    pub distance: Length,
    pub size: (u16, u16),
}

impl View {
    pub fn camera(&self, grid: &Grid<'_>) -> Camera {
        let turns = |degrees: u32| Turns::from_bits(((u64::from(degrees) << 32) / 360) as u32);
        let orbit = Orbit {
            yaw: turns(self.yaw_degrees),
            pitch: turns(self.pitch_degrees),
            distance: self.distance * grid.radius(),
        };
        let (width, height) = self.size;
        Camera::orbit(&orbit, FocalPx::from_num(height), width, height)
    }
}

/// One frame.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub name: &'static str,
    pub model: Model,
    pub rho: u8,
    pub level: u8,
    pub two_sided: bool,
    pub view: View,
    pub splat: SplatPx,
    /// How the light casts shadows.
    pub shadows: Method,
    /// Draw this part of the picture alone.
    pub band: Option<Rect>,
    /// The only surface shows its back.
    pub is_empty: bool,
    /// Whether a picture is kept; the others have their hash alone.
    pub is_pictured: bool,
}

pub fn light() -> Light {
    Light {
        towards: DVec3::new(1.0, 2.0, 1.5)
            .normalize()
            .to_array()
            .map(Unit::from_num),
        ambient: Weight::lit("0.2"),
        diffuse: Weight::lit("0.8"),
    }
}

pub fn quality(case: &Case) -> Quality {
    Quality {
        splat: case.splat,
        ..Quality::default()
    }
}

const FULL: Length = Length::lit("2.6");
const FAR: Length = Length::lit("9");
const CLOSE: Length = Length::lit("1.4");
const STANDARD: (u16, u16) = (240, 320);
const HALF: (u16, u16) = (120, 160);
const SMALL: (u16, u16) = (96, 96);

const fn view(yaw_degrees: u32, distance: Length, size: (u16, u16)) -> View {
    View {
        yaw_degrees,
        pitch_degrees: 15,
        distance,
        size,
    }
}

const fn case(name: &'static str, model: Model, rho: u8, level: u8, view: View) -> Case {
    Case {
        name,
        model,
        rho,
        level,
        two_sided: false,
        view,
        splat: SplatPx::ONE,
        shadows: Method::Off,
        band: None,
        is_empty: false,
        is_pictured: true,
    }
}

const fn two_sided(case: Case) -> Case {
    Case {
        two_sided: true,
        ..case
    }
}

const fn empty(case: Case) -> Case {
    Case {
        is_empty: true,
        ..case
    }
}

/// The hash alone: the same scene as a smaller, pictured case.
const fn hash_only(case: Case) -> Case {
    Case {
        is_pictured: false,
        ..case
    }
}

const BAND: Rect = Rect {
    left: 13,
    top: 30,
    right: 90,
    bottom: 61,
};

use Model::{Cube, Demo, Painted, Quad, Sphere, Torus};

/// Inside a two-sided sphere, 0.4 radii from its centre.
pub const INSIDE: Case = two_sided(case(
    "sphere-inside",
    Sphere,
    3,
    3,
    view(30, Length::lit("0.4"), SMALL),
));

pub const CASES: &[Case] = &[
    case("demo-3-full-0", Demo, 3, 3, view(0, FULL, HALF)),
    case("demo-3-full-90", Demo, 3, 3, view(90, FULL, HALF)),
    case("demo-3-full-180", Demo, 3, 3, view(180, FULL, HALF)),
    case("demo-3-full-270", Demo, 3, 3, view(270, FULL, HALF)),
    case("demo-3-far-0", Demo, 3, 3, view(0, FAR, STANDARD)),
    case("demo-3-close-0", Demo, 3, 3, view(0, CLOSE, HALF)),
    case("demo-4-full-0", Demo, 3, 4, view(0, FULL, STANDARD)),
    hash_only(case("demo-4-full-90", Demo, 3, 4, view(90, FULL, STANDARD))),
    hash_only(case(
        "demo-4-full-180",
        Demo,
        3,
        4,
        view(180, FULL, STANDARD),
    )),
    hash_only(case(
        "demo-4-full-270",
        Demo,
        3,
        4,
        view(270, FULL, STANDARD),
    )),
    case("demo-4-half-0", Demo, 3, 4, view(0, FULL, HALF)),
    case("demo-4-half-90", Demo, 3, 4, view(90, FULL, HALF)),
    case("demo-4-half-180", Demo, 3, 4, view(180, FULL, HALF)),
    case("demo-4-half-270", Demo, 3, 4, view(270, FULL, HALF)),
    case("demo-4-far-0", Demo, 3, 4, view(0, FAR, STANDARD)),
    case("demo-4-close-0", Demo, 3, 4, view(0, CLOSE, HALF)),
    Case {
        splat: SplatPx::lit("4"),
        ..case("demo-4-splat-4", Demo, 3, 4, view(30, FULL, HALF))
    },
    case("sphere-rho-2", Sphere, 2, 5, view(30, FULL, SMALL)),
    case("sphere-rho-3", Sphere, 3, 3, view(30, FULL, SMALL)),
    case("sphere-rho-4", Sphere, 4, 2, view(30, FULL, SMALL)),
    case("sphere-rho-5", Sphere, 5, 1, view(30, FULL, SMALL)),
    case("sphere-coarsest", Sphere, 2, 0, view(30, FULL, SMALL)),
    case("torus-rho-2", Torus, 2, 6, view(30, FULL, SMALL)),
    case("torus-rho-3", Torus, 3, 3, view(30, FULL, SMALL)),
    case("torus-rho-4", Torus, 4, 3, view(30, FULL, SMALL)),
    case("torus-rho-5", Torus, 5, 2, view(30, FULL, SMALL)),
    case("torus-rho-5-close", Torus, 5, 2, view(30, CLOSE, SMALL)),
    case("cube-rho-2", Cube, 2, 5, view(30, FULL, SMALL)),
    case("cube-rho-3", Cube, 3, 3, view(30, FULL, SMALL)),
    case("cube-rho-4", Cube, 4, 2, view(30, FULL, SMALL)),
    case("cube-rho-5", Cube, 5, 2, view(30, FULL, SMALL)),
    case(
        "cube-face-on",
        Cube,
        3,
        3,
        View {
            pitch_degrees: 0,
            ..view(0, FULL, SMALL)
        },
    ),
    case("quad-front", Quad, 3, 3, view(30, FULL, SMALL)),
    case("quad-on-boundary", Quad, 2, 5, view(30, FULL, SMALL)),
    empty(case("quad-behind", Quad, 3, 3, view(210, FULL, SMALL))),
    two_sided(case(
        "quad-behind-two-sided",
        Quad,
        3,
        3,
        view(210, FULL, SMALL),
    )),
    two_sided(case(
        "quad-two-sided-rho-5",
        Quad,
        5,
        2,
        view(210, FULL, SMALL),
    )),
    case(
        "quad-grazing",
        Quad,
        3,
        3,
        View {
            pitch_degrees: 0,
            ..view(86, FULL, SMALL)
        },
    ),
    empty(case(
        "sphere-inside-one-sided",
        Sphere,
        3,
        3,
        view(30, Length::lit("0.4"), SMALL),
    )),
    Case {
        band: Some(BAND),
        ..case("torus-band", Torus, 3, 3, view(30, FULL, SMALL))
    },
    case("painted-rho-3", Painted, 3, 4, view(30, FULL, STANDARD)),
    Case {
        shadows: Method::OnePass,
        ..case(
            "painted-shadows-rho-4",
            Painted,
            4,
            3,
            view(120, FULL, SMALL),
        )
    },
    Case {
        shadows: Method::TwoPass,
        ..case("demo-shadows", Demo, 3, 4, view(30, FULL, STANDARD))
    },
    Case {
        shadows: Method::OnePass,
        ..case("torus-shadows", Torus, 3, 3, view(120, FULL, HALF))
    },
    Case {
        shadows: Method::OnePass,
        ..case("torus-shadows-rho-4", Torus, 4, 2, view(120, FULL, SMALL))
    },
];
