//! The shells of a surface, level by level: every cell that it touches, and
//! which of them are [thin](super::thin).
//!
//! Source: Duguet and Drettakis 2003, 4.1 and 4.2. A cell's sample is the
//! surface's point nearest to its centre. That point lies at most half a
//! cell's diagonal away, so a cell keeps the primitives whose bounds meet the
//! cube around that ball: its *neighbourhood*, which its subcells inherit.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rhogrid_core::asset::node::{APERTURE_ALL, Flags};
use rhogrid_core::asset::{Rgb, Shell};

use super::cone::Sides;
use super::filter::filter;
use super::finish::finish;
use super::surface::{Aabb, Sample, Surface};
use super::thin::{Standing, column, cross_hair, thin_subset};
use super::touched::{Above, Touched, TouchedLevel};
use super::{Attributes, Cube, GridOptions, Masks, Progress, cone};
use crate::geometry::Up;

/// Cells whose primitives are gathered in one piece of work.
const CHUNK: usize = 256;

/// A grid before it is written.
#[derive(Clone, Debug)]
pub struct BakedGrid {
    /// Levels of depth 0 to depth.
    pub levels: Vec<BakedLevel>,
    /// Subdivisions of each axis of a cell.
    pub rho: u8,
    /// Which cells there are.
    pub shell: Shell,
    /// Whether every surface is drawn from both sides.
    pub two_sided: bool,
    /// Which source axis pointed up.
    pub up: Up,
    /// How masks are written.
    pub masks: Masks,
    /// How wide a sample's attribute is.
    pub attributes: Attributes,
    /// Where the grid lies in its source.
    pub cube: Cube,
    /// Diffuse colours, one to eight.
    pub materials: Vec<Rgb>,
}

/// The cells of one depth, in file order.
#[derive(Clone, Debug, Default)]
pub struct BakedLevel {
    /// Node records of the cells above.
    pub nodes: Vec<u16>,
    /// Drawn records of the cells above, where the level stores them.
    pub drawn: Vec<u16>,
    /// Attributes of the cells.
    pub attributes: Vec<u16>,
    /// Their colours, which 16-bit attributes do without.
    pub colours: Vec<Rgb>,
}

/// How much a box grows with each doubling of the cells on an axis. A surface
/// on the side of a cell touches it; where rounding decides, a child counts
/// what its parent counted, so that no touched cell is without children.
const SLACK: f64 = 1e-12;

/// A cell that will be subdivided.
struct Cell {
    place: [u32; 3],
    attribute: u16,
    colour: Rgb,
    neighbourhood: Vec<u32>,
}

/// A cell's children, and what they ask of its record.
struct Subdivision {
    two_sided: bool,
    /// Normal codes of all faces, where children hold opposed ones.
    faces: Vec<u16>,
    children: Vec<Child>,
}

struct Child {
    cell: Cell,
    /// Which subcell it is.
    bit: u8,
    /// Nobody asks in a fat shell.
    standing: Option<Standing>,
}

struct Baker<'a, S> {
    surface: &'a S,
    options: &'a GridOptions,
}

/// Subdivides the cube `depth` times.
pub(super) fn bake<S: Surface>(
    surface: &S,
    options: &GridOptions,
    depth: u8,
    progress: &(dyn Fn(Progress) + Sync),
) -> Vec<BakedLevel> {
    let baker = Baker { surface, options };
    let everything: Vec<u32> = (0..surface.count()).collect();
    let sample = baker.sample(DVec3::ZERO, &everything);
    let (attribute, colour) = (attribute(&sample), sample.colour);
    let mut levels = vec![TouchedLevel {
        above: Vec::new(),
        cells: vec![Touched {
            bit: 0,
            is_thin: true,
            attribute,
            colour,
        }],
    }];
    let mut cells = vec![Cell {
        place: [0; 3],
        attribute,
        colour,
        neighbourhood: everything,
    }];
    for above in 0..depth {
        progress(Progress::Level {
            cells: cells.len() as u64,
        });
        let leaves = above + 1 == depth;
        let mut done: Vec<Subdivision> = cells
            .par_chunks(CHUNK)
            .flat_map_iter(|chunk| {
                let done: Vec<Subdivision> = chunk
                    .iter()
                    .map(|cell| baker.subdivide(cell, above, leaves))
                    .collect();
                progress(Progress::Done {
                    cells: chunk.len() as u64,
                });
                done
            })
            .collect();
        levels.push(touched(&mut done));
        cells = done
            .into_iter()
            .flat_map(|cell| cell.children)
            .map(|child| child.cell)
            .collect();
    }
    filter(&mut levels, options);
    finish(options.rho, options.shell, &levels)
}

/// The level of all children.
fn touched(done: &mut [Subdivision]) -> TouchedLevel {
    let children = || done.iter().flat_map(|cell| &cell.children);
    let standings: Vec<([u32; 3], Standing)> = children()
        .filter_map(|child| Some((child.cell.place, child.standing?)))
        .collect();
    let mut thin = thin_subset(&standings).into_iter();
    let cells = children().map(|child| Touched {
        bit: child.bit,
        is_thin: thin.next().unwrap_or(true),
        attribute: child.cell.attribute,
        colour: child.cell.colour,
    });
    let cells = cells.collect();
    let above = done.iter_mut().map(|cell| Above {
        flags: Flags {
            aperture: APERTURE_ALL,
            two_sided: cell.two_sided,
        },
        children: cell.children.len() as u8,
        faces: std::mem::take(&mut cell.faces),
    });
    TouchedLevel {
        above: above.collect(),
        cells,
    }
}

impl<S: Surface> Baker<'_, S> {
    fn subdivide(&self, cell: &Cell, depth: u8, leaves: bool) -> Subdivision {
        let rho = u32::from(self.options.rho);
        let axis = rho.pow(u32::from(depth) + 1);
        let bounded: Vec<(u32, Aabb)> = cell
            .neighbourhood
            .iter()
            .map(|&primitive| (primitive, self.surface.bounds(primitive)))
            .collect();
        let mut children = Vec::new();
        let mut two_sided = self.options.two_sided;
        let mut is_opposed = false;
        for bit in 0..rho.pow(3) {
            let within = [bit % rho, bit / rho % rho, bit / (rho * rho)];
            let place = [0, 1, 2].map(|i| cell.place[i] * rho + within[i]);
            let (bounds, ball) = boxes(place, axis);
            let near: Vec<(u32, Aabb)> = bounded
                .iter()
                .filter(|(_, own)| own.meets(&ball))
                .copied()
                .collect();
            if !near.iter().any(|&(primitive, own)| {
                own.meets(&bounds) && self.surface.touches(primitive, &bounds)
            }) {
                continue;
            }
            let centre = bounds.min.midpoint(bounds.max);
            let (primitive, sample) = self.nearest(centre, &near);
            let facing = self.surface.facing(primitive);
            // A file cut behind this level has these children as its leaves.
            if !is_opposed && !self.options.two_sided {
                let sides = cone::sides(sample.normal, facing, self.faces(&near, &bounds));
                two_sided |= sides != Sides::Front;
                is_opposed = sides == Sides::Opposed;
            }
            let standing = (self.options.shell == Shell::Thin).then(|| Standing {
                crossed: self.crossed(&near, &bounds, slack(axis)),
                column: column(facing.unwrap_or(sample.normal)),
            });
            let cell = Cell {
                place,
                attribute: attribute(&sample),
                colour: sample.colour,
                neighbourhood: if leaves {
                    Vec::new()
                } else {
                    near.iter().map(|&(primitive, _)| primitive).collect()
                },
            };
            children.push(Child {
                cell,
                bit: bit as u8,
                standing,
            });
        }
        let faces = match is_opposed {
            true => self.codes(&bounded, &boxes(cell.place, axis / rho).0),
            false => Vec::new(),
        };
        Subdivision {
            two_sided,
            faces,
            children,
        }
    }

    /// Which segments of a cell's cross-hair the surface meets.
    fn crossed(&self, near: &[(u32, Aabb)], cell: &Aabb, slack: f64) -> [bool; 3] {
        cross_hair(cell, slack).map(|segment| {
            near.iter().any(|&(primitive, own)| {
                own.meets(&segment) && self.surface.touches(primitive, &segment)
            })
        })
    }

    /// The directions of the faces that touch a cell.
    fn faces<'b>(
        &'b self,
        near: &'b [(u32, Aabb)],
        cell: &'b Aabb,
    ) -> impl Iterator<Item = Vec3> + 'b {
        near.iter()
            .filter(|(primitive, own)| own.meets(cell) && self.surface.touches(*primitive, cell))
            .filter_map(|(primitive, _)| self.surface.facing(*primitive))
    }

    /// The normal codes of the faces that touch a cell, each once.
    fn codes(&self, near: &[(u32, Aabb)], cell: &Aabb) -> Vec<u16> {
        let mut codes: Vec<u16> = self.faces(near, cell).map(cone::code).collect();
        codes.sort_unstable();
        codes.dedup();
        codes
    }

    /// The nearest point to a centre, and the primitive that it lies on.
    fn nearest(&self, centre: DVec3, near: &[(u32, Aabb)]) -> (u32, Sample) {
        let mut found = (
            0,
            Sample {
                point: centre,
                distance_squared: f64::INFINITY,
                normal: Vec3::Y,
                material: 0,
                colour: [255; 3],
            },
        );
        for (primitive, own) in near {
            // Of equally near points, rounding aside, the first primitive's
            // counts, so that both sides of a thin sheet are of one kind.
            let nearest = found.1.distance_squared * (1.0 - 1e-9) - 1e-20;
            if own.distance_squared(centre) < nearest {
                let sample = self.surface.sample_at(*primitive, centre);
                if sample.distance_squared < nearest {
                    found = (*primitive, sample);
                }
            }
        }
        found
    }

    fn sample(&self, centre: DVec3, primitives: &[u32]) -> Sample {
        let bounded: Vec<(u32, Aabb)> = primitives
            .iter()
            .map(|&primitive| (primitive, self.surface.bounds(primitive)))
            .collect();
        self.nearest(centre, &bounded).1
    }
}

/// How far a surface may pass beside a cell and still touch it. Coordinates
/// are below one: rounding errs by some 1e-16.
fn slack(axis: u32) -> f64 {
    SLACK * f64::from(axis).log2().ceil()
}

/// A cell's box with its slack, and the box around the ball through its
/// corners.
fn boxes(place: [u32; 3], axis: u32) -> (Aabb, Aabb) {
    // Neighbours compute a shared side to the same double.
    let side = |index: u32| f64::from(2 * index as i32 - axis as i32) / f64::from(axis);
    let corner = |more: u32| DVec3::from_array(place.map(|index| side(index + more)));
    let cell = Aabb {
        min: corner(0),
        max: corner(1),
    };
    let slack = slack(axis);
    let cell = Aabb {
        min: cell.min - slack,
        max: cell.max + slack,
    };
    let ball = 3f64.sqrt() / f64::from(axis);
    (
        cell,
        Aabb::cube(cell.min.midpoint(cell.max), ball * (1.0 + 1e-12)),
    )
}

fn attribute(sample: &Sample) -> u16 {
    cone::code(sample.normal) | u16::from(sample.material) << 13
}
