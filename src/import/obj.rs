//! Wavefront OBJ and MTL by way of the tobj crate, whose gaps are closed
//! around it.
//!
//! A scan of our own checks every line and hands tobj a clean copy of the
//! text, so that tobj (which names no lines, takes NaN for a number, two
//! corners for a triangle, and stops at a `\`) sees only what it reads right.
//! tobj parses numbers, resolves materials and splits the file into models;
//! faces come back uncut, in file order, and are joined to one mesh. Groups,
//! smoothing groups and texture coordinates are not used; vertices have colours
//! where the first one has. A file
//! of vertices alone is a cloud.

mod lines;
mod mtl;
mod scan;

use std::collections::HashSet;
use std::path::Path;

use glam::DVec3;
use rhogrid_core::asset::Rgb;

use self::scan::{FaceLine, Scan};
use super::normals::NO_NORMAL;
use super::surface::{Corner, Face, Polygons, count, mesh};
use super::{Imported, estimate, shown};
use crate::error::{Error, Place};
use crate::geometry::{Cloud, Geometry, Material};

/// Kinds of unused statements that get a note of their own.
const MAX_UNUSED: usize = 8;

/// The name by which the clean text includes its materials.
const LIBRARY: &str = "mtllib materials\n";

/// Reads an OBJ file and the MTL files beside it.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Imported, Error> {
    let scan = scan::scan(file, &lines::text(bytes))?;
    if scan.face_lines.is_empty() {
        return points(file, &scan);
    }
    let mut notes = Vec::new();
    let mtl = mtl::libraries(file, &scan.libraries, &mut notes)?;
    let disagreement = |error| {
        let what = format!("the OBJ parser fails where the scan did not ({error})");
        Error::file(file, what, "export the model again, or as PLY")
    };
    let clean = [scan.points.as_str(), LIBRARY, &scan.faces].concat();
    let parsed = tobj::load_obj_buf(&mut clean.as_bytes(), &tobj::LoadOptions::default(), |_| {
        tobj::load_mtl_buf(&mut mtl.as_bytes())
    });
    let (models, materials) = parsed.map_err(|error| disagreement(error.to_string()))?;
    let materials = materials.map_err(|error| disagreement(error.to_string()))?;
    note_unused(&scan, &materials, &mut notes);
    let polygons = join(&models, &materials, &scan.face_lines)
        .ok_or_else(|| disagreement("it returns other faces".to_owned()))?;
    let mesh = mesh(file, polygons, &mut notes)?;
    Ok(Imported {
        geometry: Geometry::Mesh(mesh),
        notes,
    })
}

/// A file without faces: a cloud, unless it has lines.
fn points(file: &Path, scan: &Scan) -> Result<Imported, Error> {
    if scan.vertices == 0 {
        let what = "no vertices and no faces";
        let remedy = "is this a Wavefront OBJ model? export it again";
        return Err(Error::file(file, what, remedy));
    }
    if let Some((_, line)) = scan.unused.get("l") {
        let what = "nothing to draw: lines but no faces";
        let remedy = "export faces, or the vertices alone: a point cloud";
        return Err(Error::at(file, Place::Line(*line), what, remedy));
    }
    let mut notes = Vec::new();
    note_unused(scan, &[], &mut notes);
    let normals = scan.points.lines().filter(|line| line.starts_with("vn"));
    match normals.count() {
        0 => {}
        normals => notes.push(format!(
            "{} not used: OBJ does not pair them with points; PLY does (nx ny nz)",
            count(normals, "normal")
        )),
    }
    let vertices: Vec<(DVec3, Option<DVec3>)> = scan.points.lines().filter_map(vertex).collect();
    let positions: Vec<DVec3> = vertices.iter().map(|vertex| vertex.0).collect();
    let colours: Option<Vec<DVec3>> = vertices.iter().map(|vertex| vertex.1).collect();
    let cloud = Cloud {
        colours: whole_colours(&colours.unwrap_or_default()),
        ..estimate::cloud(file, &positions, &mut notes)?
    };
    Ok(Imported {
        geometry: Geometry::Cloud(cloud),
        notes,
    })
}

/// The position in a checked `v` statement, and its colour.
fn vertex(line: &str) -> Option<(DVec3, Option<DVec3>)> {
    let numbers = lines::words(line.strip_prefix("v ")?).map(|word| lines::number(word).ok());
    match numbers.collect::<Option<Vec<f64>>>()?[..] {
        [x, y, z] => Some((DVec3::new(x, y, z), None)),
        [x, y, z, weight] => Some((DVec3::new(x, y, z) / weight, None)),
        [x, y, z, red, green, blue] => {
            Some((DVec3::new(x, y, z), Some(DVec3::new(red, green, blue))))
        }
        _ => None,
    }
}

fn note_unused(scan: &Scan, materials: &[tobj::Material], notes: &mut Vec<String>) {
    let known: HashSet<&str> = materials
        .iter()
        .map(|material| material.name.as_str())
        .collect();
    let unknown = scan
        .materials
        .iter()
        .filter(|(name, _)| !known.contains(name.as_str()));
    let unknown: Vec<_> = unknown.collect();
    if let Some((name, line)) = unknown.iter().min_by_key(|(_, line)| *line) {
        let number = count(unknown.len(), "material");
        notes.push(format!(
            "{number} not defined, the first `{}` on line {line}: white",
            shown(name)
        ));
    }
    for (line, name) in scan.dangling.iter().zip(["texture coordinates", "normals"]) {
        if let Some(line) = line {
            notes.push(format!(
                "line {line}: a face names {name}, but the file has none"
            ));
        }
    }
    if (1..scan.vertices).contains(&scan.coloured) {
        let without = scan.vertices - scan.coloured;
        notes.push(format!(
            "vertex colours not used: {} without",
            count(without, "vertex")
        ));
    }
    for (keyword, (number, line)) in scan.unused.iter().take(MAX_UNUSED) {
        let number = count(*number, "statement");
        notes.push(format!(
            "{number} `{}` not used, the first on line {line}",
            shown(keyword)
        ));
    }
    if scan.unused.len() > MAX_UNUSED {
        let more = scan.unused.len() - MAX_UNUSED;
        notes.push(format!(
            "{} of statement more not used",
            count(more, "kind")
        ));
    }
}

/// One set of polygons from all models, or `None` if their faces are not
/// those of the scan. Materials follow a white one.
fn join(
    models: &[tobj::Model],
    materials: &[tobj::Material],
    lines: &[FaceLine],
) -> Option<Polygons> {
    let mut polygons = Polygons {
        materials: std::iter::once(Material::white())
            .chain(materials.iter().map(material))
            .collect(),
        ..Polygons::default()
    };
    let mut lines = lines.iter();
    let mut colours = Vec::new();
    for tobj::Model { mesh, .. } in models {
        colours.extend(mesh.vertex_color.chunks_exact(3).map(DVec3::from_slice));
        let first_position = u32::try_from(polygons.positions.len()).ok()?;
        let first_normal = u32::try_from(polygons.normals.len()).ok()?;
        polygons
            .positions
            .extend(mesh.positions.chunks_exact(3).map(DVec3::from_slice));
        polygons
            .normals
            .extend(mesh.normals.chunks_exact(3).map(DVec3::from_slice));
        let material = u32::try_from(mesh.material_id.map_or(0, |id| id + 1)).ok()?;
        // Triangles alone come without their sizes.
        let triangles = if mesh.face_arities.is_empty() {
            mesh.indices.len() / 3
        } else {
            0
        };
        let sizes = mesh
            .face_arities
            .iter()
            .copied()
            .chain(std::iter::repeat_n(3, triangles));
        let mut start = 0;
        for size in sizes {
            let FaceLine { line, has_normals } = *lines.next()?;
            let range = start..start + size as usize;
            start = range.end;
            for i in range {
                let normal = if has_normals {
                    first_normal + mesh.normal_indices.get(i)?
                } else {
                    NO_NORMAL
                };
                polygons.corners.push(Corner {
                    position: first_position + mesh.indices.get(i)?,
                    normal,
                    colour: first_position + mesh.indices.get(i)?,
                });
            }
            polygons.faces.push(Face {
                end: polygons.corners.len(),
                material,
                place: Place::Line(line),
            });
        }
    }
    polygons.colours = whole_colours(&colours);
    let is_whole = [0, polygons.positions.len()].contains(&polygons.colours.len());
    (is_whole && lines.next().is_none()).then_some(polygons)
}

/// Colours in 255ths: of ones if none exceeds one, as most tools write them,
/// else as they are.
fn whole_colours(colours: &[DVec3]) -> Vec<Rgb> {
    let largest = colours.iter().map(|colour| colour.max_element());
    let scale = if largest.fold(0.0, f64::max) > 1.0 {
        1.0
    } else {
        255.0
    };
    let whole = colours.iter().map(|colour| {
        let channels = (*colour * scale)
            .round()
            .clamp(DVec3::ZERO, DVec3::splat(255.0));
        channels.to_array().map(|channel| channel as u8)
    });
    whole.collect()
}

fn material(material: &tobj::Material) -> Material {
    Material {
        name: material.name.clone(),
        diffuse: material.diffuse.map_or([255; 3], |colour| {
            colour.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8)
        }),
    }
}
