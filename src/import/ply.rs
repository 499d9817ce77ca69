//! PLY: meshes and clouds, ascii and binary of both byte orders.
//!
//! Based on: G. Turk, The PLY Polygon File Format, 1994. Any scalar and list
//! types, any order of elements; what is unknown is skipped. Polygons come
//! from the element `face`, triangle strips from `tristrips` (-1 separates).
//! A file with neither is a cloud; without normals they are estimated. Vertices
//! have colours where they have `red`, `green` and `blue`: of floats one is full,
//! of integers the type's largest value.

mod body;
mod header;

use std::path::Path;

use glam::DVec3;

use self::body::{Body, whole};
use self::header::{Element, Header, Kind, Scalar};
use super::normals::single;
use super::surface::{Face, Polygons, corner, count, mesh};
use super::{Imported, estimate, in_range, shown, unit};
use crate::error::{Error, Place};
use crate::geometry::{Cloud, Geometry, Material, OrientedPoint};

/// Makes faces of a list of vertices, `None` where a strip restarts.
type AddList<'a> = fn(&mut Reader<'a>, &[Option<u32>], Place) -> Result<(), Error>;

const INDEX_LISTS: &[&str] = &["vertex_indices", "vertex_index"];

/// Whether the first line of a file says PLY.
pub(super) fn has_magic(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

/// Reads a PLY file.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Imported, Error> {
    let header = header::read(file, bytes)?;
    let mut reader = Reader::new(file, &header)?;
    let mut body = Body::new(file, &header, bytes);
    for element in &header.elements {
        reader.element(element, &mut body)?;
    }
    let Reader {
        polygons,
        has_normals,
        mut notes,
        zero_normal,
        ..
    } = reader;
    note_unused(&body, &mut notes);
    let geometry = if polygons.faces.is_empty() {
        Geometry::Cloud(if has_normals {
            cloud(file, polygons, zero_normal)?
        } else {
            Cloud {
                colours: polygons.colours,
                ..estimate::cloud(file, &polygons.positions, &mut notes)?
            }
        })
    } else {
        Geometry::Mesh(mesh(file, polygons, &mut notes)?)
    };
    Ok(Imported { geometry, notes })
}

fn note_unused(body: &Body, notes: &mut Vec<String>) {
    if let Some(line) = body.surplus_line {
        notes.push(format!(
            "line {line} holds more values than the header declares"
        ));
    }
    match body.left() {
        0 => {}
        left => notes.push(format!(
            "{} behind the last element not used",
            count(left, "byte")
        )),
    }
}

/// What the elements have given so far.
struct Reader<'a> {
    file: &'a Path,
    vertices: u64,
    has_normals: bool,
    polygons: Polygons,
    /// The first vertex whose normal is zero, which a cloud cannot have.
    zero_normal: Option<(usize, Place)>,
    notes: Vec<String>,
}

impl<'a> Reader<'a> {
    fn new(file: &'a Path, header: &Header) -> Result<Self, Error> {
        let Some(vertex) = header.element("vertex") else {
            let what = "the header has no element `vertex`";
            return Err(Error::file(file, what, "is this a model?"));
        };
        let failed =
            |what: &str, remedy| Err(Error::at(file, Place::Line(vertex.line), what, remedy));
        if ["x", "y", "z"]
            .iter()
            .any(|name| scalar(vertex, name).is_none())
        {
            return failed(
                "the vertices lack a coordinate",
                "declare scalar properties x, y and z",
            );
        }
        if vertex.count == 0 {
            return failed("nothing to draw: no vertices", "is the file complete?");
        }
        if vertex.count > u64::from(u32::MAX) {
            return failed(
                "more than 4,294,967,295 vertices",
                "simplify the model first",
            );
        }
        Ok(Self {
            file,
            vertices: vertex.count,
            has_normals: ["nx", "ny", "nz"]
                .iter()
                .all(|name| scalar(vertex, name).is_some()),
            polygons: Polygons {
                materials: vec![Material::white()],
                ..Polygons::default()
            },
            zero_normal: None,
            notes: Vec::new(),
        })
    }

    fn element(&mut self, element: &'a Element, body: &mut Body<'a>) -> Result<(), Error> {
        body.begin_element(element)?;
        let indices = element.find(INDEX_LISTS);
        match (
            element.name.as_str(),
            indices.map(|i| element.properties[i].kind),
        ) {
            ("vertex", _) => self.vertices(element, body),
            ("face", Some(Kind::List { .. })) => self.lists(element, body, Self::face),
            ("tristrips", Some(Kind::List { .. })) => self.lists(element, body, Self::strip),
            ("face" | "tristrips", _) if element.count > 0 => {
                let what = format!("element `{}` has no list of vertex indices", element.name);
                let remedy = "declare `property list uchar int vertex_indices`";
                Err(Error::at(
                    self.file,
                    Place::Line(element.line),
                    what,
                    remedy,
                ))
            }
            // Without properties, entries have no bytes however many.
            _ if element.properties.is_empty() || element.count == 0 => Ok(()),
            (name, _) => {
                self.notes
                    .push(format!("element `{}` not used", shown(name)));
                each_entry(element, body, |body, _, kind| body.skip(kind))
            }
        }
    }

    fn vertices(&mut self, element: &'a Element, body: &mut Body<'a>) -> Result<(), Error> {
        let axes = ["x", "y", "z", "nx", "ny", "nz"].map(|name| scalar(element, name));
        let channels = ["red", "green", "blue"].map(|name| scalar(element, name));
        let has_colours = channels.iter().all(Option::is_some);
        let used = if self.has_normals { 6 } else { 3 };
        let mut values = [0.0; 6];
        let mut colour = [0; 3];
        let place_of =
            |names: &[Option<usize>], place| names.iter().position(|at| *at == Some(place));
        let last = element.properties.len() - 1;
        each_entry(element, body, |body, place, kind| {
            match (
                place_of(&axes[..used], place),
                place_of(&channels, place),
                kind,
            ) {
                (Some(axis), _, Kind::Scalar(scalar)) => values[axis] = coordinate(body, scalar)?,
                (_, Some(channel), Kind::Scalar(scalar)) if has_colours => {
                    colour[channel] = channel_of(body, scalar)?;
                }
                _ => body.skip(kind)?,
            }
            if place == last {
                let [x, y, z, nx, ny, nz] = values;
                let normal = DVec3::new(nx, ny, nz);
                if self.has_normals {
                    if normal == DVec3::ZERO {
                        let index = self.polygons.positions.len();
                        self.zero_normal.get_or_insert((index, body.place()));
                    }
                    self.polygons.normals.push(normal);
                }
                if has_colours {
                    self.polygons.colours.push(colour);
                }
                self.polygons.positions.push(DVec3::new(x, y, z));
            }
            Ok(())
        })
    }

    /// Reads entries whose index list `add` turns into faces.
    fn lists(
        &mut self,
        element: &'a Element,
        body: &mut Body<'a>,
        add: AddList<'a>,
    ) -> Result<(), Error> {
        let place = element.find(INDEX_LISTS);
        let is_strip = element.name == "tristrips";
        let mut indices = Vec::new();
        each_entry(element, body, |body, property, kind| match kind {
            Kind::List { count, item } if Some(property) == place => {
                indices.clear();
                let count = body.list_count(count, item)?;
                let start = body.place();
                for _ in 0..count {
                    let value = body.value(item)?;
                    indices.push(if is_strip && value == -1.0 {
                        None
                    } else {
                        Some(self.index(body, value)?)
                    });
                }
                add(self, &indices, start)
            }
            _ => body.skip(kind),
        })
    }

    fn index(&self, body: &Body, value: f64) -> Result<u32, Error> {
        match whole(value) {
            Some(index) if (index as u64) < self.vertices => Ok(index as u32),
            _ => {
                let last = self.vertices - 1;
                let what = format!("vertex index {value} where the last vertex is {last}");
                Err(body.error(what, "indices count from 0"))
            }
        }
    }

    fn face(&mut self, indices: &[Option<u32>], place: Place) -> Result<(), Error> {
        if indices.len() < 3 {
            let what = format!("a face of {}", count(indices.len(), "corner"));
            return Err(Error::at(self.file, place, what, "a face needs 3 or more"));
        }
        self.push_face(indices.iter().flatten().copied(), place);
        Ok(())
    }

    /// Every vertex from the third on makes a triangle with the two before
    /// it, turned over alternately.
    fn strip(&mut self, indices: &[Option<u32>], place: Place) -> Result<(), Error> {
        for strip in indices.split(Option::is_none) {
            for (i, corners) in strip.windows(3).enumerate() {
                let &[Some(a), Some(b), Some(c)] = corners else {
                    continue;
                };
                // Repeated vertices lead on to another part of the strip.
                if a != b && b != c && c != a {
                    self.push_face(if i % 2 == 0 { [a, b, c] } else { [b, a, c] }, place);
                }
            }
        }
        Ok(())
    }

    fn push_face(&mut self, indices: impl IntoIterator<Item = u32>, place: Place) {
        let has_normals = self.has_normals;
        let Polygons { corners, faces, .. } = &mut self.polygons;
        corners.extend(indices.into_iter().map(|index| corner(index, has_normals)));
        faces.push(Face {
            end: corners.len(),
            material: 0,
            place,
        });
    }
}

/// Calls `read` for every property of every entry; it reads the value.
fn each_entry<'a>(
    element: &'a Element,
    body: &mut Body<'a>,
    mut read: impl FnMut(&mut Body<'a>, usize, Kind) -> Result<(), Error>,
) -> Result<(), Error> {
    for entry in 0..element.count {
        body.begin_entry(entry)?;
        for (place, property) in element.properties.iter().enumerate() {
            read(body, place, property.kind)?;
        }
        body.end_entry();
    }
    Ok(())
}

/// The place of a property of one value.
fn scalar(element: &Element, name: &str) -> Option<usize> {
    element
        .find(&[name])
        .filter(|&i| matches!(element.properties[i].kind, Kind::Scalar(_)))
}

/// A channel of a colour in 255ths of what is full.
fn channel_of(body: &mut Body, scalar: Scalar) -> Result<u8, Error> {
    let value = body.value(scalar)?;
    let full = match scalar {
        Scalar::F32 | Scalar::F64 => 1.0,
        Scalar::I8 => f64::from(i8::MAX),
        Scalar::U8 => f64::from(u8::MAX),
        Scalar::I16 => f64::from(i16::MAX),
        Scalar::U16 => f64::from(u16::MAX),
        Scalar::I32 => f64::from(i32::MAX),
        Scalar::U32 => f64::from(u32::MAX),
    };
    if value.is_finite() {
        return Ok((value / full * 255.0).round().clamp(0.0, 255.0) as u8);
    }
    let what = format!("the colour {value} is not a finite number");
    Err(body.error(what, "remove the colours, or export the model again"))
}

/// A finite number in the range of `f32`.
fn coordinate(body: &mut Body, scalar: Scalar) -> Result<f64, Error> {
    let value = body.value(scalar)?;
    if in_range(value) {
        return Ok(value);
    }
    let what = if value.is_finite() {
        format!("the coordinate {value:e} is beyond the range of 32-bit floats")
    } else {
        format!("the coordinate {value} is not a finite number")
    };
    Err(body.error(what, "remove the vertex, or repair the scan"))
}

fn cloud(
    file: &Path,
    vertices: Polygons,
    zero_normal: Option<(usize, Place)>,
) -> Result<Cloud, Error> {
    if let Some((index, place)) = zero_normal {
        return Err(Error::at(
            file,
            place,
            format!("the normal of point {index} is zero"),
            "remove the point, or the properties nx, ny and nz: normals are estimated then",
        ));
    }
    estimate::check_extent(file, &vertices.positions)?;
    let point = |(position, normal): (&DVec3, &DVec3)| {
        let normal = single(unit(*normal).unwrap_or(DVec3::Y));
        OrientedPoint {
            position: *position + DVec3::ZERO,
            normal,
        }
    };
    let points = vertices
        .positions
        .iter()
        .zip(&vertices.normals)
        .map(point)
        .collect();
    Ok(Cloud {
        points,
        colours: vertices.colours,
        two_sided: false,
    })
}
