//! The paper's models, and what stands for them here.

use std::path::{Path, PathBuf};

use super::Comparison;
use crate::error::Error;
use crate::geometry::{Geometry, Up};
use crate::import::procedural;
use crate::report::{Effort, Model};

/// A model of the paper.
#[derive(Clone, Debug)]
pub struct Subject {
    /// As the paper calls it.
    pub name: &'static str,
    /// What stands for it.
    pub ours: &'static str,
    up: Up,
    /// Where that is; `None` where it is built in, or not there.
    path: Option<PathBuf>,
}

/// All of them.
pub struct Subjects {
    pub bunny: Subject,
    pub dragon: Subject,
    pub buddha: Subject,
    pub blade: Subject,
    pub arbre: Subject,
    pub saule: Subject,
}

const BUILT_IN: &str = "builtin:";

impl Subject {
    fn new(folder: Option<&Path>, name: &'static str, ours: &'static str, up: Up) -> Self {
        let path = folder.map(|folder| folder.join(ours));
        Self {
            name,
            ours,
            up,
            path: path.filter(|path| path.is_file()),
        }
    }

    /// Loads it, if it is there.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn load(&self, comparison: &Comparison<'_>) -> Result<Option<Model>, Error> {
        let effort = &Effort::FULL;
        if let Some(name) = self.ours.strip_prefix(BUILT_IN) {
            let mesh = procedural::built_in(name);
            let model =
                mesh.map(|mesh| Model::new(self.ours.into(), Geometry::Mesh(mesh), Up::Y, effort));
            return model.transpose();
        }
        let path = self.path.as_deref();
        let model = path.map(|path| {
            (comparison.progress)(&format!("reads {}", path.display()));
            Model::load(path, self.up, effort)
        });
        model.transpose()
    }
}

impl Subjects {
    /// Those of a folder.
    ///
    /// # Errors
    /// When the folder has none of them.
    pub fn new(folder: Option<&Path>) -> Result<Self, Error> {
        let subject = |name, ours, up| Subject::new(folder, name, ours, up);
        let subjects = Self {
            bunny: subject("Bunny", "bunny.ply", Up::Y),
            dragon: subject("Dragon", "dragon_res2.ply", Up::Y),
            buddha: subject("Buddha", "buddha_100k.ply", Up::Z),
            blade: subject("Blade", "turbine_blade_199k.ply", Up::Z),
            arbre: subject("Arbre", "builtin:tree-broad", Up::Y),
            saule: subject("Saule", "builtin:tree-willow", Up::Y),
        };
        match folder {
            Some(folder) if subjects.all().iter().all(|subject| subject.path.is_none()) => {
                let files = subjects.all().map(|subject| subject.ours);
                let files = files.into_iter().filter(|file| !file.starts_with(BUILT_IN));
                let files: Vec<&str> = files.collect();
                Err(Error::file(
                    folder,
                    "holds none of the paper's models",
                    format!(
                        "give a folder with {}, or leave --models out",
                        files.join(", ")
                    ),
                ))
            }
            _ => Ok(subjects),
        }
    }

    /// In the order of table 4.
    pub fn all(&self) -> [&Subject; 6] {
        [
            &self.bunny,
            &self.dragon,
            &self.buddha,
            &self.blade,
            &self.arbre,
            &self.saule,
        ]
    }
}
