//! Bakers: geometry -> assets. One file or folder for each kind; all write
//! through [`writer`].

mod cone;
mod dictionary;
mod filter;
mod finish;
mod overlap;
mod points;
mod shell;
mod surface;
mod thin;
mod touched;
mod triangles;
pub mod writer;

use glam::DVec3;
use rhogrid_core::asset::{Shell, max_depth};

use crate::error::{Error, Place};
use crate::geometry::{Geometry, Material, Up};

pub use shell::{BakedGrid, BakedLevel};
pub use surface::{Aabb, Sample, Surface};

/// Which normals and colours intermediate samples have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// The mean of the leaves below, where that tells something.
    #[default]
    Filtered,
    /// Those of the surface's points nearest to the cells' centres, as leaves
    /// have them.
    Nearest,
}

/// What a grid baker is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridOptions {
    /// Subdivisions of each axis of a cell, 2 to 5.
    pub rho: u8,
    /// Level k has rho^(k + 1) cells on an axis.
    pub level: u8,
    /// Which cells to keep.
    pub shell: Shell,
    /// Which normals and colours intermediate samples have.
    pub normals: Normals,
    /// Draw every surface from both sides, as geometry may demand by itself.
    pub two_sided: bool,
    /// Which source axis points up; the geometry is already turned, the asset
    /// remembers it.
    pub up: Up,
    /// How masks are written.
    pub masks: Masks,
    /// How wide a sample's attribute is; `None` for 16 bits, or 32 where the
    /// geometry has colours.
    pub attributes: Option<Attributes>,
}

/// How wide a sample's attribute is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attributes {
    /// 13-bit normal and 3-bit material.
    Bits16,
    /// With a 16-bit colour.
    Bits32,
    /// With a 24-bit colour.
    Bits48,
}

/// How the masks of the finest levels are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Masks {
    /// As they are.
    Plain,
    /// As indices into a dictionary of the most frequent ones, where that
    /// saves bytes. For tri-grids.
    Dictionary,
}

impl Default for GridOptions {
    fn default() -> Self {
        Self {
            rho: 3,
            level: 4,
            shell: Shell::Thin,
            normals: Normals::Filtered,
            two_sided: false,
            up: Up::Y,
            masks: Masks::Plain,
            attributes: None,
        }
    }
}

/// Where a grid lies in its source: the tight centred bounding cube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    /// Middle of the geometry's box, source units, y up.
    pub centre: DVec3,
    /// Half of the box's sides.
    pub extents: DVec3,
    /// Half of the box's longest side.
    pub half_side: f64,
    /// Distance of the farthest vertex from the centre.
    pub radius: f64,
}

/// Bakes a rho-grid. `progress` hears of every finished intermediate cell
/// and of how many there are at its depth.
///
/// # Errors
/// When rho or the level is out of range, the masks are not rho's, or the geometry has no extent.
pub fn grid(
    geometry: &Geometry,
    options: &GridOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<BakedGrid, Error> {
    let options = &GridOptions {
        two_sided: options.two_sided || geometry.two_sided(),
        ..*options
    };
    let depth = depth_of(options)?;
    let cube = Cube::of(geometry)?;
    let grid = match geometry {
        Geometry::Mesh(mesh) => {
            let surface = triangles::MeshSurface::new(mesh, &cube);
            shell::bake(&surface, options, depth, progress)
        }
        Geometry::Cloud(cloud) => {
            let surface = points::CloudSurface::new(cloud, &cube);
            shell::bake(&surface, options, depth, progress)
        }
    };
    let materials = match geometry {
        Geometry::Mesh(mesh) => mesh.materials.clone(),
        Geometry::Cloud(_) => vec![Material::white()],
    };
    Ok(BakedGrid {
        levels: grid,
        rho: options.rho,
        shell: options.shell,
        two_sided: options.two_sided,
        up: options.up,
        masks: options.masks,
        attributes: options.attributes.unwrap_or(match geometry.has_colours() {
            true => Attributes::Bits32,
            false => Attributes::Bits16,
        }),
        cube,
        materials: materials.iter().map(|material| material.diffuse).collect(),
    })
}

/// Geometry as a baker sees it, in the cube's coordinates.
pub fn surface(geometry: &Geometry, cube: &Cube) -> Box<dyn Surface> {
    match geometry {
        Geometry::Mesh(mesh) => Box::new(triangles::MeshSurface::new(mesh, cube)),
        Geometry::Cloud(cloud) => Box::new(points::CloudSurface::new(cloud, cube)),
    }
}

/// What a baker reports while it works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// A level starts; so many cells will be subdivided.
    Level {
        /// Cells to subdivide.
        cells: u64,
    },
    /// So many cells were subdivided.
    Done {
        /// Cells subdivided.
        cells: u64,
    },
}

fn depth_of(options: &GridOptions) -> Result<u8, Error> {
    let GridOptions {
        rho, level, masks, ..
    } = *options;
    let fail = |what: String, remedy: String| {
        Err(Error {
            file: None,
            place: Place::Whole,
            what,
            remedy,
        })
    };
    if !(2..=5).contains(&rho) {
        return fail(
            format!("--rho {rho} is not possible"),
            "give 2, 3, 4 or 5".into(),
        );
    }
    let deepest = max_depth(rho) - 1;
    if level > deepest {
        return fail(
            format!("--level {level} is too deep for --rho {rho}"),
            format!("give at most {deepest}"),
        );
    }
    if masks == Masks::Dictionary && rho != 3 {
        return fail(
            format!("--masks dictionary is not possible with --rho {rho}"),
            "give --rho 3".into(),
        );
    }
    Ok(level + 1)
}

impl Cube {
    /// The corners of the geometry's box.
    pub fn corners(&self) -> Vec<DVec3> {
        let signs = (0..8).map(|corner| {
            let sign = |axis: usize| f64::from(corner >> axis & 1) * 2.0 - 1.0;
            DVec3::new(sign(0), sign(1), sign(2))
        });
        signs
            .map(|sign| self.centre + sign * self.extents)
            .collect()
    }

    /// The tight centred bounding cube of geometry.
    ///
    /// # Errors
    /// When the geometry has no extent.
    pub fn of(geometry: &Geometry) -> Result<Self, Error> {
        let bounds = geometry.bounds().filter(|bounds| bounds.half_side() > 0.0);
        let Some(bounds) = bounds else {
            return Err(Error {
                file: None,
                place: Place::Whole,
                what: "the geometry has no extent".into(),
                remedy: "give at least two different points".into(),
            });
        };
        Ok(Self {
            centre: bounds.centre(),
            extents: (bounds.max - bounds.centre()).max(bounds.centre() - bounds.min),
            half_side: bounds.half_side(),
            radius: bounds.radius,
        })
    }
}
