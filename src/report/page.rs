//! `report.md`: the chapters' texts and tables, made of rows.

use std::fmt;

use super::{CHAPTERS, Report, models_of, of_chapter};

/// A Markdown table of numbers.
pub(super) struct Table {
    text: String,
}

impl Table {
    /// A table with these columns, the first of which is text.
    pub fn new(columns: &[&str]) -> Self {
        let rule = "---|".repeat(columns.len());
        Self {
            text: format!("| {} |\n|{rule}\n", columns.join(" | ")),
        }
    }

    /// A line of figures; what was not measured stays empty.
    pub fn line(
        &mut self,
        name: String,
        values: impl IntoIterator<Item = Option<f64>>,
        digits: usize,
    ) {
        let number =
            |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.digits$}"));
        let cells: Vec<String> = values.into_iter().map(number).collect();
        self.text += &format!("| {name} | {} |\n", cells.join(" | "));
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The page.
pub(super) fn page(report: &Report) -> String {
    let mut text = heading(report);
    for chapter in &CHAPTERS {
        let rows = of_chapter(&report.rows, chapter.name);
        text += &format!("\n## {}\n\n{}", chapter.title, chapter.introduction);
        if let Some(plot) = &chapter.plot {
            text += &format!("\n![{}]({})\n", chapter.title, plot.file);
        }
        for model in models_of(&rows) {
            let own = rows.iter().filter(|row| row.model == model);
            let own: Vec<_> = own.copied().collect();
            text += &format!("\n### {model}\n\n{}", (chapter.write)(&own));
        }
    }
    text
}

fn heading(report: &Report) -> String {
    let effort = &report.effort;
    let build = match cfg!(debug_assertions) {
        true => "a build that traps overflow: its times are not those of a release",
        false => "a release build",
    };
    let machine = report.machine.as_ref().map_or(String::new(), |machine| {
        format!(
            " Instructions are those of the whole draw call on {}, counted by \
             `targets/run {} FILE.rho --view full`: exact, and no time.",
            machine.name, machine.name
        )
    });
    format!(
        "<!-- Written by `rhogrid report`; data.csv has every figure. -->\n\
         # Rhogrid {}: report\n\n\
         Pictures are {}x{}, seen from the four full views (distance 2.6 radii, pitch 15 degrees, \
         yaw 0, 90, 180 and 270); figures are means of the four. Quality is `psnr_inside` against \
         the reference with 4x4 samples a pixel. Times are those of the draw call on the host \
         ({}, {}): medians of {} rounds, in which all calls take turns. They hold for this host, \
         this day; compare them within one report.{machine}\n",
        env!("CARGO_PKG_VERSION"),
        effort.width,
        effort.height,
        std::env::consts::ARCH,
        build,
        effort.rounds,
    )
}
