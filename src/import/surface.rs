//! Polygons as a reader finds them, and the mesh they become.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;
use rhogrid_core::asset::Rgb;

use super::normals::{self, NO_NORMAL};
use super::{materials, polygon};
use crate::error::{Error, Place};
use crate::geometry::{Material, Mesh, Triangle};

/// One corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Index into [`Polygons::positions`].
    pub position: u32,
    /// Index into [`Polygons::normals`], or [`NO_NORMAL`].
    pub normal: u32,
    /// Index into [`Polygons::colours`], if there are any.
    pub colour: u32,
}

/// A face: the corners from the end of the face before it to its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// End in [`Polygons::corners`].
    pub end: usize,
    /// Index into [`Polygons::materials`].
    pub material: u32,
    /// Where the file has it.
    pub place: Place,
}

/// What a reader hands over. Indices are in range, numbers finite, faces have
/// three corners or more.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    pub positions: Vec<DVec3>,
    /// Of any length; zero means none.
    pub normals: Vec<DVec3>,
    /// Of all vertices, or none.
    pub colours: Vec<Rgb>,
    pub corners: Vec<Corner>,
    pub faces: Vec<Face>,
    pub materials: Vec<Material>,
}

/// Triangles whose material is still the file's.
#[derive(Default)]
struct Cut {
    triangles: Vec<Triangle>,
    /// Of the triangles' corners, if there are any.
    colours: Vec<[Rgb; 3]>,
    materials: Vec<u32>,
    without_area: Vec<Place>,
}

/// Makes the mesh.
///
/// # Errors
///
/// When no triangle has an area: there is nothing to draw.
pub(super) fn mesh(
    file: &Path,
    mut polygons: Polygons,
    notes: &mut Vec<String>,
) -> Result<Mesh, Error> {
    weld(&mut polygons, notes);
    let Cut {
        mut triangles,
        colours,
        materials,
        without_area,
    } = cut(file, &polygons)?;
    if u32::try_from(triangles.len() * 3).is_err() {
        return Err(Error::file(
            file,
            "has more than 1,431,655,765 triangles",
            "simplify it first",
        ));
    }
    let facet =
        |t: &Triangle| normals::face_normal(t.positions.map(|i| polygons.positions[i as usize]));
    let facets: Vec<Option<DVec3>> = triangles.iter().map(facet).collect();
    if facets.iter().all(Option::is_none) {
        let place = polygons
            .faces
            .first()
            .map_or(Place::Whole, |face| face.place);
        let what = format!(
            "nothing to draw: none of {} has an area",
            count(polygons.faces.len(), "face")
        );
        return Err(Error::at(
            file,
            place,
            what,
            "check the scale and the export of the model",
        ));
    }
    if let Some(place) = without_area.first() {
        let polygons = count(without_area.len(), "polygon");
        notes.push(format!(
            "{polygons} without area dropped, the first at {}",
            show(*place)
        ));
    }
    let (normals, zero) = normals::resolve(
        &polygons.positions,
        &mut triangles,
        &facets,
        &polygons.normals,
    );
    if zero > 0 {
        notes.push(format!(
            "{} with a zero normal: implied by the faces",
            count(zero, "corner")
        ));
    }
    let reduced = materials::reduce(&polygons.materials, &materials);
    if reduced.merged > 0 {
        let limit = materials::MAX_MATERIALS;
        let rest = count(reduced.merged, "colour");
        notes.push(format!(
            "more than {limit} colours: {rest} replaced by the nearest of the {limit} most used"
        ));
    }
    for (triangle, material) in triangles.iter_mut().zip(reduced.of_triangles) {
        triangle.material = material;
    }
    let (positions, materials) = (polygons.positions, reduced.materials);
    Ok(Mesh {
        positions,
        normals,
        triangles,
        materials,
        colours,
        two_sided: false,
    })
}

/// A number and its noun, in the plural where due.
pub(super) fn count(number: usize, noun: &str) -> String {
    let plural = match noun.strip_suffix("ex") {
        Some(stem) => format!("{stem}ices"),
        None => format!("{noun}s"),
    };
    if number == 1 {
        format!("1 {noun}")
    } else {
        format!("{number} {plural}")
    }
}

/// A place in words.
fn show(place: Place) -> String {
    match place {
        Place::Whole => "an unknown place".to_owned(),
        Place::Line(line) => format!("line {line}"),
        Place::Byte(offset) => format!("byte {offset}"),
    }
}

/// Joins positions of equal bits and drops those without a face, so that
/// faces that meet also share their positions. Zero has one sign.
fn weld(polygons: &mut Polygons, notes: &mut Vec<String>) {
    const UNUSED: u32 = u32::MAX;
    let mut places = vec![UNUSED; polygons.positions.len()];
    for corner in &polygons.corners {
        places[corner.position as usize] = 0;
    }
    let unused = places.iter().filter(|&&place| place == UNUSED).count();
    if unused > 0 {
        notes.push(format!(
            "{} without a face not used",
            count(unused, "vertex")
        ));
    }
    let mut known = HashMap::with_capacity(places.len() - unused);
    let mut welded = Vec::with_capacity(places.len() - unused);
    for (place, position) in places.iter_mut().zip(&polygons.positions) {
        if *place != UNUSED {
            let position = *position + DVec3::ZERO;
            *place = *known
                .entry(position.to_array().map(f64::to_bits))
                .or_insert_with(|| {
                    welded.push(position);
                    welded.len() as u32 - 1
                });
        }
    }
    for corner in &mut polygons.corners {
        corner.position = places[corner.position as usize];
    }
    polygons.positions = welded;
}

/// Cuts the faces into triangles. Triangles without area stay.
fn cut(file: &Path, polygons: &Polygons) -> Result<Cut, Error> {
    let mut cut = Cut::default();
    let (mut start, mut ring) = (0, Vec::new());
    for face in &polygons.faces {
        let corners = &polygons.corners[start..face.end];
        start = face.end;
        if corners.len() == 3 {
            cut.push(polygons, corners, [0, 1, 2], face.material);
            continue;
        }
        ring.clear();
        ring.extend(
            corners
                .iter()
                .map(|corner| polygons.positions[corner.position as usize]),
        );
        let triangles = polygon::triangulate(&ring).ok_or_else(|| {
            let what = format!(
                "a polygon of {} corners is too intricate to cut",
                ring.len()
            );
            Error::at(
                file,
                face.place,
                what,
                "triangulate the model before its export",
            )
        })?;
        if triangles.is_empty() {
            cut.without_area.push(face.place);
        }
        for triangle in triangles {
            cut.push(polygons, corners, triangle, face.material);
        }
    }
    Ok(cut)
}

impl Cut {
    fn push(&mut self, polygons: &Polygons, corners: &[Corner], at: [usize; 3], material: u32) {
        if !polygons.colours.is_empty() {
            let colour = |i: usize| polygons.colours[corners[i].colour as usize];
            self.colours.push(at.map(colour));
        }
        self.triangles.push(Triangle {
            positions: at.map(|i| corners[i].position),
            normals: at.map(|i| corners[i].normal),
            material: 0,
        });
        self.materials.push(material);
    }
}

/// The corner of a position that has the file's colour and normal of the same
/// index, or no normal.
pub(super) fn corner(position: u32, has_normal: bool) -> Corner {
    Corner {
        position,
        normal: if has_normal { position } else { NO_NORMAL },
        colour: position,
    }
}
