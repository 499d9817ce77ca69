//! A check of every OBJ statement that counts, and a clean copy of it.
//!
//! The copy holds `v`, `vn`, then `usemtl` and `f` statements alone: one a
//! line, with absolute indices, without texture coordinates. What the parser
//! behind would misread (lines as triangles, missing indices as zero, NaN) is
//! reported with its line here, or left out.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use super::super::shown;
use super::lines::{Statement, each_statement, number, words};
use crate::error::{Error, Place};

/// What a face has that its clean copy does not say.
pub(super) struct FaceLine {
    pub line: usize,
    pub has_normals: bool,
}

/// A checked file.
#[derive(Default)]
pub(super) struct Scan {
    /// `v` and `vn` statements.
    pub points: String,
    /// `usemtl` and `f` statements.
    pub faces: String,
    /// One for each `f`, in order.
    pub face_lines: Vec<FaceLine>,
    /// What follows each `mtllib`, with its line.
    pub libraries: Vec<(usize, String)>,
    /// Names of used materials, with the line of their first use.
    pub materials: BTreeMap<String, usize>,
    /// Statements without a use here: how many, and the first one's line.
    pub unused: BTreeMap<String, (usize, usize)>,
    pub vertices: usize,
    /// How many of them have a colour; it is kept where all have one.
    pub coloured: usize,
    /// The first line with texture coordinate and normal indices into an
    /// empty list; exporters that leave lists out exist.
    pub dangling: [Option<usize>; 2],
}

/// What is wrong, and what to do.
type Fault = (String, &'static str);

const NUMBERS: &str = "write plain finite numbers";
const INDICES: &str = "indices count from 1, or back from the last one with -1";
const CORNERS: &str = "write every corner of a face as v, v/vt, v//vn or v/vt/vn";

/// Least numbers of a vertex with a colour.
const COLOURED: usize = 6;

/// How many `v`, `vt` and `vn` statements there are.
type Counts = [usize; 3];

/// Names of the three indices of a corner.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Checks a text. The first bad line in file order is the error.
pub(super) fn scan(file: &Path, text: &str) -> Result<Scan, Error> {
    // Faces may name vertices that follow them, so all are counted first.
    let mut total: Counts = [0; 3];
    let mut coloured = 0;
    let counted: Result<(), Error> = each_statement(text, |statement| {
        if let Some(kind) = kind(statement.keyword) {
            total[kind] += 1;
        }
        let has_colour = statement.keyword == "v" && words(statement.rest).count() >= COLOURED;
        coloured += usize::from(has_colour);
        Ok(())
    });
    counted?;
    let mut scan = Scan {
        vertices: total[0],
        coloured,
        ..Scan::default()
    };
    let mut read: Counts = [0; 3];
    each_statement(text, |statement| {
        let line = statement.line;
        let done = scan.statement(&statement, read, total);
        if let Some(kind) = kind(statement.keyword) {
            read[kind] += 1;
        }
        done.map_err(|(what, remedy)| Error::at(file, Place::Line(line), what, remedy))
    })?;
    Ok(scan)
}

/// The index kind that a statement adds one to.
fn kind(keyword: &str) -> Option<usize> {
    ["v", "vt", "vn"].iter().position(|kind| *kind == keyword)
}

impl Scan {
    fn statement(
        &mut self,
        statement: &Statement,
        read: Counts,
        total: Counts,
    ) -> Result<(), Fault> {
        let &Statement {
            line,
            keyword,
            rest,
        } = statement;
        match keyword {
            "v" => self.vertex(rest)?,
            "vn" => self.normal(rest)?,
            "f" => self.face(line, rest, read, total)?,
            "mtllib" if rest.is_empty() => return Err(unnamed(keyword)),
            "mtllib" => self.libraries.push((line, rest.to_owned())),
            "usemtl" if rest.is_empty() => return Err(unnamed(keyword)),
            "usemtl" => {
                self.materials.entry(rest.to_owned()).or_insert(line);
                push_line(&mut self.faces, format_args!("usemtl {rest}"));
            }
            "vt" | "o" | "g" | "s" => {}
            _ => self.unused.entry(keyword.to_owned()).or_insert((0, line)).0 += 1,
        }
        Ok(())
    }

    /// `v x y z`, `v x y z w` or `v x y z` and a colour of 3 or 4 numbers.
    fn vertex(&mut self, rest: &str) -> Result<(), Fault> {
        let words: Vec<&str> = words(rest).collect();
        let numbers = numbers(&words)?;
        let used = match numbers[..] {
            [_, _, _] => 3,
            [_, _, _, _, _, _] | [_, _, _, _, _, _, _] if self.coloured < self.vertices => 3,
            [_, _, _, _, _, _] | [_, _, _, _, _, _, _] => COLOURED,
            [x, y, z, w] => {
                if ![x, y, z]
                    .iter()
                    .all(|coordinate| super::super::in_range(coordinate / w))
                {
                    return Err((
                        format!("the weight `{}` is too small", shown(words[3])),
                        NUMBERS,
                    ));
                }
                4
            }
            _ => {
                let what = format!("a vertex of {} numbers", words.len());
                return Err((what, "write 3, or 4 with a weight, or 6 with a colour"));
            }
        };
        push_line(
            &mut self.points,
            format_args!("v {}", words[..used].join(" ")),
        );
        Ok(())
    }

    fn normal(&mut self, rest: &str) -> Result<(), Fault> {
        let words: Vec<&str> = words(rest).collect();
        if numbers(&words)?.len() != 3 {
            return Err((format!("a normal of {} numbers", words.len()), "write 3"));
        }
        push_line(&mut self.points, format_args!("vn {}", words.join(" ")));
        Ok(())
    }

    fn face(&mut self, line: usize, rest: &str, read: Counts, total: Counts) -> Result<(), Fault> {
        let corners = words(rest).map(|word| Ok((word, corner(word, read, total)?)));
        let corners: Vec<(&str, [Option<usize>; 3])> = corners.collect::<Result<_, Fault>>()?;
        let &[(first, form), .., _] = &corners[..] else {
            return Err(too_few(corners.len()));
        };
        if corners.len() < 3 {
            return Err(too_few(corners.len()));
        }
        for (kind, dangling) in self.dangling.iter_mut().enumerate() {
            if form[kind + 1].is_some() && total[kind + 1] == 0 {
                dangling.get_or_insert(line);
            }
        }
        let parts = |form: [Option<usize>; 3]| form.map(|index| index.is_some());
        if let Some((other, _)) = corners.iter().find(|corner| parts(corner.1) != parts(form)) {
            return Err((
                format!(
                    "corners `{}` and `{}` differ in form",
                    shown(first),
                    shown(other)
                ),
                CORNERS,
            ));
        }
        let has_normals = form[2].is_some() && total[2] > 0;
        self.faces.push('f');
        for (_, [vertex, _, normal]) in &corners {
            let vertex = vertex.unwrap_or(0);
            // Writing to a String cannot fail.
            let _ = match normal.filter(|_| has_normals) {
                Some(normal) => write!(self.faces, " {vertex}//{normal}"),
                None => write!(self.faces, " {vertex}"),
            };
        }
        self.faces.push('\n');
        self.face_lines.push(FaceLine { line, has_normals });
        Ok(())
    }
}

fn push_line(text: &mut String, line: std::fmt::Arguments) {
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{line}");
}

fn unnamed(keyword: &str) -> Fault {
    (
        format!("`{keyword}` without a name"),
        "name a material or its file",
    )
}

fn too_few(corners: usize) -> Fault {
    let corners = super::super::surface::count(corners, "corner");
    (
        format!("a face of {corners}"),
        "a face needs 3 or more; write edges as `l`, points as `p`",
    )
}

fn numbers(words: &[&str]) -> Result<Vec<f64>, Fault> {
    words
        .iter()
        .map(|word| number(word).map_err(|what| (what, NUMBERS)))
        .collect()
}

/// The absolute indices, from 1, of a corner such as `7`, `7/1`, `7//2` or
/// `-1/-1/-1`; an empty index is as good as none.
fn corner(word: &str, read: Counts, total: Counts) -> Result<[Option<usize>; 3], Fault> {
    let mut indices = [None; 3];
    for (kind, part) in word.split('/').enumerate() {
        if kind >= 3 {
            return Err((
                format!("corner `{}` has more than 3 indices", shown(word)),
                CORNERS,
            ));
        }
        if !part.is_empty() {
            indices[kind] = Some(index(part, kind, read[kind], total[kind])?);
        }
    }
    if indices[0].is_none() {
        return Err((format!("corner `{}` names no vertex", shown(word)), CORNERS));
    }
    Ok(indices)
}

/// An absolute index from 1.
fn index(word: &str, kind: usize, read: usize, total: usize) -> Result<usize, Fault> {
    let name = KINDS[kind];
    let Ok(value) = word.parse::<i64>() else {
        return Err((
            format!(
                "{name} index `{}` is not an integer of 64 bits",
                shown(word)
            ),
            INDICES,
        ));
    };
    let size = usize::try_from(value.unsigned_abs()).unwrap_or(usize::MAX);
    match value {
        0 => Err((format!("{name} index 0"), INDICES)),
        _ if kind > 0 && total == 0 => Ok(size),
        1.. if size <= total => Ok(size),
        ..0 if size <= read => Ok(read + 1 - size),
        _ => {
            let number = if value < 0 { read } else { total };
            let so_far = if value < 0 { " so far" } else { "" };
            Err((
                format!("{name} index {value} where the file has {number}{so_far}"),
                INDICES,
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_become_absolute() {
        let corner = |word| corner(word, [5, 3, 2], [9, 3, 2]).ok();
        assert_eq!(corner("9"), Some([Some(9), None, None]));
        assert_eq!(corner("-5/-1/-2"), Some([Some(1), Some(3), Some(1)]));
        assert_eq!(corner("1//"), Some([Some(1), None, None]));
        for bad in [
            "10",
            "-6",
            "0",
            "1/0",
            "//1",
            "",
            "1/1/1/1",
            "1.0",
            "1//3",
            "99999999999999999999",
        ] {
            assert_eq!(corner(bad), None, "{bad}");
        }
        assert_eq!(corner("-9223372036854775808"), None);
    }

    #[test]
    fn the_clean_copy_is_plain() {
        let text = "l 1 2 3\nv 0 0 0 # a\nf -1//1 2//1 \\\n 3//1\nv 1 0 0 .5 .5 .5\nvt 7\nv 0 1 0\nvn 0 0 1\n";
        let scan = scan("a.obj".as_ref(), text).unwrap();
        assert_eq!(scan.points, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n");
        assert_eq!(scan.faces, "f 1//1 2//1 3//1\n");
        assert_eq!(scan.face_lines[0].line, 3);
        assert_eq!(scan.unused["l"], (1, 1));
    }
}
