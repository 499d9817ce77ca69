//! Geometry as the baker and the reference see it: triangles or oriented
//! points, y up, in source units, checked finite by import.

use glam::{DVec3, Vec3};
use rhogrid_core::asset::Rgb;

/// A surface material: a diffuse colour without gamma. The renderer's
/// materials number at most eight (3 bits of a 16-bit attribute).
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the source file, or empty.
    pub name: String,
    /// Diffuse red, green, blue, 0 to 255.
    pub diffuse: Rgb,
}

impl Material {
    /// The default: white.
    pub fn white() -> Self {
        Self {
            name: String::new(),
            diffuse: [255; 3],
        }
    }
}

/// One triangle, counter-clockwise seen from its front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Mesh::positions`].
    pub positions: [u32; 3],
    /// Indices into [`Mesh::normals`], one for each corner.
    pub normals: [u32; 3],
    /// Index into [`Mesh::materials`].
    pub material: u8,
}

/// An indexed triangle mesh. Every index is in range, every position finite,
/// every normal of unit length.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions in source units.
    pub positions: Vec<DVec3>,
    /// Unit shading normals.
    pub normals: Vec<Vec3>,
    /// At least one triangle.
    pub triangles: Vec<Triangle>,
    /// One to eight materials.
    pub materials: Vec<Material>,
    /// Colours of all triangles' corners, which take the place of materials'
    /// where samples hold colours; empty without any.
    pub colours: Vec<[Rgb; 3]>,
    /// Whether back faces are seen, whatever is asked for: leaves, say.
    pub two_sided: bool,
}

/// A point of an oriented cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedPoint {
    /// Position in source units.
    pub position: DVec3,
    /// Unit normal.
    pub normal: Vec3,
}

/// A point cloud whose points carry normals. At least one point.
#[derive(Clone, Debug, Default)]
pub struct Cloud {
    /// The points.
    pub points: Vec<OrientedPoint>,
    /// As many colours; empty without any.
    pub colours: Vec<Rgb>,
    /// Whether backs are seen, whatever is asked for: normals of unknown sign.
    pub two_sided: bool,
}

/// What an input file holds.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles.
    Mesh(Mesh),
    /// Oriented points without connectivity.
    Cloud(Cloud),
}

/// Which source axis points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Up {
    /// +x is up: (x, y, z) becomes (-y, x, z).
    X,
    /// +y is up: nothing changes.
    #[default]
    Y,
    /// +z is up: (x, y, z) becomes (x, z, -y).
    Z,
}

impl Up {
    /// The axis's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }

    /// Rotates a source vector so that y is up (a proper rotation, so that
    /// handedness and winding stay).
    pub fn to_y_up(self, vector: DVec3) -> DVec3 {
        let DVec3 { x, y, z } = vector;
        match self {
            Self::X => DVec3::new(-y, x, z),
            Self::Y => vector,
            Self::Z => DVec3::new(x, z, -y),
        }
    }
}

/// Centre and radius of a model (DESIGN: middle of the axis-aligned box of
/// the referenced vertices; farthest referenced vertex from it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
    /// Distance of the farthest point from [`Bounds::centre`].
    pub radius: f64,
}

impl Bounds {
    /// Bounds of points. `None` without any.
    pub fn of(points: impl Iterator<Item = DVec3> + Clone) -> Option<Self> {
        let (min, max) = points
            .clone()
            .map(|point| (point, point))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let centre = min.midpoint(max);
        let radius = points
            .map(|point| point.distance(centre))
            .fold(0.0, f64::max);
        Some(Self { min, max, radius })
    }

    /// Middle of the box.
    pub fn centre(&self) -> DVec3 {
        self.min.midpoint(self.max)
    }

    /// Half the longest side of the box: the half side of the tight centred
    /// bounding cube.
    pub fn half_side(&self) -> f64 {
        (self.max - self.min).max_element() / 2.0
    }
}

impl Geometry {
    /// Turns the geometry so that y is up.
    pub fn turned(mut self, up: Up) -> Self {
        let turn = |v: Vec3| up.to_y_up(v.as_dvec3()).as_vec3();
        match &mut self {
            Self::Mesh(mesh) => {
                mesh.positions.iter_mut().for_each(|p| *p = up.to_y_up(*p));
                mesh.normals.iter_mut().for_each(|n| *n = turn(*n));
            }
            Self::Cloud(cloud) => {
                for point in &mut cloud.points {
                    point.position = up.to_y_up(point.position);
                    point.normal = turn(point.normal);
                }
            }
        }
        self
    }

    /// What the box is around: the vertices that triangles use, or the points.
    pub fn points(&self) -> Vec<DVec3> {
        match self {
            Self::Mesh(mesh) => {
                let corners = mesh
                    .triangles
                    .iter()
                    .flat_map(|triangle| triangle.positions);
                corners.map(|at| mesh.positions[at as usize]).collect()
            }
            Self::Cloud(cloud) => cloud.points.iter().map(|point| point.position).collect(),
        }
    }

    /// Whether it has colours besides materials'.
    pub fn has_colours(&self) -> bool {
        match self {
            Self::Mesh(mesh) => !mesh.colours.is_empty(),
            Self::Cloud(cloud) => !cloud.colours.is_empty(),
        }
    }

    /// Whether it is seen from both sides, whatever is asked for.
    pub fn two_sided(&self) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.two_sided,
            Self::Cloud(cloud) => cloud.two_sided,
        }
    }

    /// Bounds of everything that is referenced.
    pub fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Mesh(mesh) => Bounds::of(
                mesh.triangles
                    .iter()
                    .flat_map(|t| t.positions.map(|i| mesh.positions[i as usize])),
            ),
            Self::Cloud(cloud) => Bounds::of(cloud.points.iter().map(|p| p.position)),
        }
    }
}
