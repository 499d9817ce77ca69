//! Figures 5 and 6: pictures.

use super::Comparison;
use super::drawing::{Content, ONE_PASS, SHADOWED_POINTS, Sight, Way};
use super::subject::{Subject, Subjects};
use crate::bake::GridOptions;
use crate::cli::ViewArgs;
use crate::error::Error;
use crate::measure::against_reference;
use crate::picture::Picture;
use crate::reference::{DEFAULT_SAMPLES_PER_AXIS, Reference};
use crate::report::Model;
use crate::report::model::{bright, camera};
use crate::report::page::Table;
use crate::view;

/// A view of a figure.
struct Look {
    name: &'static str,
    /// The same for `targets/run`: yaw, pitch, distance.
    view: &'static str,
    /// Radii from the centre.
    distance: f64,
    panels: &'static [Panel],
}

/// A picture of a figure.
#[derive(Clone, Copy)]
struct Panel {
    way: Way,
    level: u8,
    /// The paper's frames a second.
    paper: Option<f64>,
}

const fn panel(way: Way, level: u8, paper: Option<f64>) -> Panel {
    Panel { way, level, paper }
}

impl Panel {
    /// The same as a comparison draws it: a quick one has the finest panels
    /// alone, of a level and a model that the paper has no rates of.
    fn under(&self, comparison: &Comparison<'_>) -> Option<Self> {
        if !comparison.quick {
            return Some(*self);
        }
        let level = comparison.levels()[0];
        (self.level == FINEST).then(|| panel(self.way, level, None))
    }
}

/// The finest level of the figures.
const FINEST: u8 = 5;

const fn far(panels: &'static [Panel]) -> Look {
    Look {
        name: "far",
        view: "0,15,2.6",
        distance: 2.6,
        panels,
    }
}

const FIGURE_5: [Look; 2] = [
    far(&[
        panel(SHADOWED_POINTS, 4, Some(4.15)),
        panel(SHADOWED_POINTS, 5, Some(0.63)),
        panel(ONE_PASS, 5, Some(2.85)),
    ]),
    Look {
        name: "near",
        view: "0,15,1.4",
        distance: 1.4,
        panels: &[
            panel(SHADOWED_POINTS, 4, Some(4.15)),
            panel(SHADOWED_POINTS, 5, Some(0.63)),
            panel(ONE_PASS, 5, Some(1.42)),
        ],
    },
];
const FIGURE_6: [Look; 1] = [far(&[
    panel(SHADOWED_POINTS, 5, None),
    panel(ONE_PASS, 5, None),
])];

/// Writes the pictures, and gives what there is to say of them.
///
/// # Errors
/// When a model cannot be read, a picture cannot be written, or the machine
/// cannot be run.
pub fn write(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<String, Error> {
    let [buddha, dragon] = match comparison.quick {
        true => [&subjects.arbre; 2],
        false => [&subjects.buddha, &subjects.dragon],
    };
    let mut figure_5 = Figure::new(5, buddha);
    let mut figure_6 = Figure::new(6, dragon);
    for look in &FIGURE_5 {
        figure_5.look(comparison, look)?;
    }
    for look in &FIGURE_6 {
        figure_6.look(comparison, look)?;
    }
    Ok(format!(
        "\n## Figures 5 and 6\n\n\
        Pictures are in {}, all with shadows: points, every leaf one, in two passes, splats in one. \
        *Far* is 2.6 radii away, *near* 1.4, yaw 0, pitch 15 degrees: the first of the *full* and \
        of the *close* views. {} PSNR is that of the pixels that the model covers, against traced \
        rays, 4x4 a pixel. Pixels that points have missed are closed from their neighbours.\n{}{}",
        comparison.out.display(),
        comparison.about_speed(),
        figure_5.text(comparison),
        figure_6.text(comparison) + &figure_6.difference(),
    ))
}

/// A figure on its way.
struct Figure<'a> {
    number: u8,
    subject: &'a Subject,
    lines: Vec<Line>,
    pictures: Vec<Drawn>,
}

/// A line of its table: name, the paper's frames a second, ours, PSNR.
type Line = (String, [Option<f64>; 3]);

/// A picture, and which of its pixels lie in shadow.
struct Drawn {
    picture: Picture,
    shadowed: Vec<bool>,
}

impl<'a> Figure<'a> {
    fn new(number: u8, subject: &'a Subject) -> Self {
        Self {
            number,
            subject,
            lines: Vec::new(),
            pictures: Vec::new(),
        }
    }

    /// Draws the pictures of a view, if the model is there.
    fn look(&mut self, comparison: &Comparison<'_>, look: &Look) -> Result<(), Error> {
        let model = self.subject.load(comparison)?;
        let view = ViewArgs {
            distance: look.distance,
            ..Model::full_views()[0].clone()
        };
        let light = view::Light {
            casts: true,
            ..bright()
        };
        let reference = model.map(|model| {
            (comparison.progress)(&format!("{}: traces {}", model.name, look.name));
            model.reference(&view, light, DEFAULT_SAMPLES_PER_AXIS)
        });
        for panel in look.panels {
            let Some(panel) = panel.under(comparison) else {
                continue;
            };
            let name = format!("{}, {}, level {}", look.name, panel.way.name, panel.level);
            let (Some(model), Some(reference)) = (model, &reference) else {
                let name = format!("{name}, {}", self.subject.absence().unwrap_or_default());
                self.lines.push((name, [panel.paper, None, None]));
                continue;
            };
            let shown = Shown {
                model,
                view: &view,
                run_view: look.view,
                panel,
            };
            let (drawn, [speed, psnr]) = shown.draw(comparison, reference)?;
            let file = self.file(look, &panel);
            drawn.picture.save_png(&comparison.out.join(&file))?;
            let name = format!("[{name}]({file})");
            self.lines.push((name, [panel.paper, speed, psnr]));
            self.pictures.push(drawn);
        }
        Ok(())
    }

    fn file(&self, look: &Look, panel: &Panel) -> String {
        let way = panel.way.name.replace(' ', "-");
        format!("{}-{}-{way}-{}.png", self.number, look.name, panel.level)
    }

    fn text(&self, comparison: &Comparison<'_>) -> String {
        let ours = format!("ours, {}", comparison.unit());
        let mut table = Table::new(&["picture", "the paper, frames/s", &ours, "psnr inside, dB"]);
        for (name, values) in &self.lines {
            table.line(name.clone(), *values, 2);
        }
        let title = self.subject.title();
        format!("\n### Figure {}: {title}\n\n{table}", self.number)
    }

    /// How far its two pictures' shadows differ.
    fn difference(&self) -> String {
        let [points, splats] = &self.pictures[..] else {
            return String::new();
        };
        let both = |at: &usize| points.picture.drawn[*at] && splats.picture.drawn[*at];
        let both: Vec<usize> = (0..points.shadowed.len()).filter(both).collect();
        let share = |differs: &dyn Fn(usize) -> bool| {
            let differing = both.iter().filter(|&&at| differs(at)).count();
            100.0 * differing as f64 / both.len().max(1) as f64
        };
        let colour = |at: usize| {
            let channels = points.picture.rgb[at].iter().zip(splats.picture.rgb[at]);
            { channels }.any(|(a, b)| a.abs_diff(b) > 25)
        };
        format!(
            "\nOf the pixels that both pictures draw, {:.2}% are in shadow in one of them alone, and \
            {:.2}% differ by more than a tenth in a channel.\n",
            share(&|at| points.shadowed[at] != splats.shadowed[at]),
            share(&colour),
        )
    }
}

/// What a picture shows.
struct Shown<'a> {
    model: &'a Model,
    view: &'a ViewArgs,
    /// The view of `targets/run`.
    run_view: &'static str,
    panel: Panel,
}

impl Shown<'_> {
    /// The picture; how fast it is drawn, and its PSNR.
    fn draw(
        &self,
        comparison: &Comparison<'_>,
        reference: &Reference,
    ) -> Result<(Drawn, [Option<f64>; 2]), Error> {
        let way = &self.panel.way;
        let options = GridOptions {
            level: self.panel.level,
            ..GridOptions::default()
        };
        let baked = self.model.baked(options, comparison.progress)?;
        let camera = camera(&baked.asset, self.view);
        let content = Content::Asset(&baked.asset);
        let picture = way.draw(&content, &camera, 1).picture();
        let lit = way.lit().draw(&content, &camera, 1).picture();
        let pixels = picture.rgb.iter().zip(&lit.rgb);
        let shadowed = pixels.map(|(own, lit)| own != lit).collect();
        // Sizes are the view's.
        let measures = against_reference(&picture, None, reference).ok();
        let psnr = measures.and_then(|measures| measures.psnr_inside);
        let sight = Sight {
            name: &self.model.name,
            content,
            view: self.run_view,
            cameras: vec![camera],
        };
        let speed = comparison.speed(&sight, way)?;
        Ok((Drawn { picture, shadowed }, [speed, psnr]))
    }
}
