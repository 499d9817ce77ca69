//! The paper's models, and what stands for them here.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use super::Comparison;
use crate::error::Error;
use crate::geometry::{Geometry, Up};
use crate::import::procedural;
use crate::report::{Effort, Model};

/// A model of the paper.
pub struct Subject {
    /// As the paper calls it.
    pub name: &'static str,
    /// What stands for it.
    pub ours: &'static str,
    up: Up,
    place: Place,
    /// Once it was loaded.
    model: OnceCell<Model>,
}

/// Where what stands for a model is.
enum Place {
    BuiltIn(&'static str),
    File(PathBuf),
    /// It is a file, and no folder was named.
    Nowhere,
    NotIn(PathBuf),
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
        let place = match (ours.strip_prefix(BUILT_IN), folder) {
            (Some(name), _) => Place::BuiltIn(name),
            (None, None) => Place::Nowhere,
            (None, Some(folder)) => match folder.join(ours) {
                path if path.is_file() => Place::File(path),
                _ => Place::NotIn(folder.into()),
            },
        };
        Self {
            name,
            ours,
            up,
            place,
            model: OnceCell::new(),
        }
    }

    /// Its name and what stands for it.
    pub fn title(&self) -> String {
        format!("{} ({})", self.name, self.ours)
    }

    /// What the line of a level is called: its title, the level, why it is not
    /// there.
    pub fn line(&self, level: u8) -> String {
        line(&self.title(), level, self.absence())
    }

    /// Why it is not there, if it is not.
    pub fn absence(&self) -> Option<String> {
        match &self.place {
            Place::BuiltIn(_) | Place::File(_) => None,
            Place::Nowhere => Some("needs --models".into()),
            Place::NotIn(folder) => Some(format!("not in {}", folder.display())),
        }
    }

    /// Loads it, if it is there and was not loaded before.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn load(&self, comparison: &Comparison<'_>) -> Result<Option<&Model>, Error> {
        if self.model.get().is_none()
            && let Some(model) = self.read(comparison)?
        {
            // Nobody else has set it.
            let _ = self.model.set(model);
        }
        Ok(self.model.get())
    }

    fn read(&self, comparison: &Comparison<'_>) -> Result<Option<Model>, Error> {
        let effort = &Effort::FULL;
        match &self.place {
            Place::BuiltIn(name) => procedural::built_in(name)
                .map(|mesh| Model::new(self.ours.into(), Geometry::Mesh(mesh), self.up, effort))
                .transpose(),
            Place::File(path) => {
                (comparison.progress)(&format!("reads {}", path.display()));
                Model::load(path, self.up, effort).map(Some)
            }
            Place::Nowhere | Place::NotIn(_) => Ok(None),
        }
    }
}

/// What the line of a level is called.
pub fn line(title: &str, level: u8, absence: Option<String>) -> String {
    let absence = absence.map(|absence| format!(", {absence}"));
    format!("{title}, {level}{}", absence.unwrap_or_default())
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
        let is_file = |subject: &&Subject| matches!(subject.place, Place::File(_));
        match folder {
            Some(folder) if !subjects.all().iter().any(is_file) => {
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
        let [dragon, buddha, blade, arbre, saule] = self.of_big_scene();
        [&self.bunny, dragon, buddha, blade, arbre, saule]
    }

    /// What stands in the Big Scene.
    pub fn of_big_scene(&self) -> [&Subject; 5] {
        [
            &self.dragon,
            &self.buddha,
            &self.blade,
            &self.arbre,
            &self.saule,
        ]
    }

    /// Why not all of that is there, if it is not.
    pub fn absence_from_big_scene(&self) -> Option<String> {
        self.of_big_scene().into_iter().find_map(Subject::absence)
    }
}
