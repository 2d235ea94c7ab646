//! The comparison as Markdown and plots.

use std::fmt::Write;

use enmm::model::case::Integrator;

use super::{Comparison, Entry, FAILING, Failure, Totals};
use crate::Plot;

impl Comparison {
    /// The comparison as a document; `pictures` are the files of the plots, in their order.
    pub fn markdown(&self, pictures: &[String]) -> String {
        let mut text = format!("{HEAD}\n{}", super::origin());
        if self.quick {
            text += "\nThis is a quick run: small models, whose times say little.\n";
        }
        for model in models(&self.entries) {
            let _ = write!(text, "\n## {}{}\n\n{TABLE}", model[..1].to_uppercase(), &model[1..]);
            let mine: Vec<&Entry> = self.entries.iter().filter(|e| e.model == model).collect();
            mine.iter().for_each(|e| text += &line(e));
            text += &verdict(model, &mine);
        }
        text += &failures(&self.failures);
        let _ = write!(text, "\n## Size of the implicit step: sliding block\n\n{TABLE}");
        self.sweep.iter().for_each(|e| text += &line(e));
        text += &sweep_verdict(&self.sweep);
        for (plot, picture) in self.plots.iter().zip(pictures) {
            let _ = write!(text, "\n![{}]({picture})\n", plot.title);
        }
        text.lines().map(folded).collect()
    }
}

/// A line with its end; prose is folded to the width of the documents, tables are not.
fn folded(line: &str) -> String {
    if line.starts_with('|') || line.starts_with('!') {
        return format!("{line}\n");
    }
    let indent = if line.starts_with("- ") { "\n  " } else { "\n" };
    format!("{}\n", crate::text::wrapped(line, COLUMNS).replace('\n', indent))
}

/// Columns of prose.
const COLUMNS: usize = 110;

const HEAD: &str = "# The explicit method beside the implicit one\n\n\
Written by `cargo xtask compare`; every number was measured in one run on one machine, both methods in turn on the \
same models, covers, contacts and joint laws. The implicit method is Newmark's rule with β = ½, γ = 1 as in \
discontinuous deformation analysis, a global stiffness of elements and contact springs, sparse Cholesky with the \
symbolic factorisation kept while the pattern holds, and open–close iteration with refactorisation; it runs on one \
thread. Its default step is 20 explicit ones. The error is that against the exact answer; for the slope, which has \
none, it is the root mean square of the difference of the blocks' final places from the explicit ones, relative to \
their displacement.\n";

const TABLE: &str = "| variant | method | blocks | covers | contacts | dt [s] | error | wall [s] | CPU [s] | steps | \
iterations | factorisations | memory [MB] | at rest |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\
---|\n";

fn models(entries: &[Entry]) -> Vec<&'static str> {
    let mut models: Vec<&'static str> = entries.iter().map(|e| e.model).collect();
    models.dedup();
    models
}

fn line(e: &Entry) -> String {
    let method = if e.integrator == Integrator::Explicit { "explicit" } else { "implicit" };
    let [blocks, covers, contacts] = e.counts;
    format!(
        "| {} | {method} | {blocks} | {covers} | {contacts} | {:.2e} | {:.2e} | {:.2} | {:.2} | {} | {} | {} | {:.2} \
         | {} |\n",
        e.variant,
        e.dt,
        e.error,
        e.wall,
        e.cpu,
        e.steps[1],
        e.iterations,
        e.factorisations,
        e.bytes as f64 / 1e6,
        if e.at_rest { "yes" } else { "no" }
    )
}

/// Times of the implicit over the explicit method by size, and what was counted; no cause that was not measured.
fn verdict(model: &str, entries: &[&Entry]) -> String {
    let mut text = String::from("\n");
    let mut ratios = Vec::new();
    for pair in entries.chunks_exact(2) {
        let ratio = pair[1].wall / pair[0].wall;
        let winner = match ratio {
            r if r > 1.1 => "the explicit method is faster",
            r if r < 0.9 => "the implicit method is faster",
            _ => "neither is faster by more than a tenth",
        };
        let per_step = pair[1].factorisations as f64 / pair[1].steps[1].max(1) as f64;
        let _ = writeln!(
            text,
            "- {}: {winner}; implicit over explicit {ratio:.2} in wall time, with {per_step:.1} factorisations per \
             implicit sub-step.",
            pair[0].variant
        );
        ratios.push(ratio);
    }
    if let (Some(first), Some(last)) = (ratios.first(), ratios.last()) {
        let _ = writeln!(
            text,
            "- {model}: from the smallest to the largest model this ratio goes from {first:.2} to {last:.2}."
        );
    }
    text
}

/// Slopes that fail: their cost, and how far their totals are from those of the explicit method.
fn failures(failures: &[Failure]) -> String {
    let mut text = format!(
        "\n## Slope that fails\n\nSlopes of that kind fail under a friction of 28°. Times and counts are \
         those of {FAILING} s of failure alone, which both methods cover. Single blocks go their own ways, so that \
         totals are compared; the error is that of the mean displacement of all rock against that of the explicit \
         method.\n\n{TABLE}"
    );
    failures.iter().for_each(|failure| text += &line(&failure.entry));
    let entries: Vec<&Entry> = failures.iter().map(|failure| &failure.entry).collect();
    text += &verdict("slope that fails", &entries);
    let names = Totals::NAMES.map(|(name, unit)| format!("{name} [{unit}]")).join(" | ");
    let _ = write!(text, "\n| variant | method | {names} |\n|---|---|---:|---:|---:|---:|\n");
    for pair in failures.chunks_exact(2) {
        let [explicit, implicit] = [pair[0].totals.values(), pair[1].totals.values()];
        let known = explicit.map(|value| format!("{value:.4e}")).join(" | ");
        let other = |k: usize| format!("{:.4e} ({:+.1} %)", implicit[k], 100.0 * (implicit[k] / explicit[k] - 1.0));
        let _ = writeln!(text, "| {} | explicit | {known} |", pair[0].entry.variant);
        let _ = writeln!(text, "| {} | implicit | {} |", pair[1].entry.variant, [0, 1, 2, 3].map(other).join(" | "));
    }
    text
}

/// The largest implicit step that is as accurate as the explicit method.
fn sweep_verdict(sweep: &[Entry]) -> String {
    let Some((explicit, implicit)) = sweep.split_first() else { return String::new() };
    let fair = implicit.iter().filter(|e| e.error.abs() <= explicit.error.abs());
    let fair = fair.max_by(|a, b| a.dt.total_cmp(&b.dt));
    match fair {
        Some(e) => format!(
            "\nThe largest implicit step of this list that is as accurate as the explicit method is nominally \
             {:.2e} s, \
             {:.0} explicit steps; with its cuts it took {} sub-steps for the explicit {}, and {:.2} times the wall \
             time.\n",
            e.dt,
            e.dt / explicit.dt,
            e.steps[1],
            explicit.steps[1],
            e.wall / explicit.wall
        ),
        None => "\nNo implicit step of this list is as accurate as the explicit method.\n".into(),
    }
}

/// Cost over size for every model, and error over the implicit step.
pub(super) fn plots(entries: &[Entry], failures: &[Failure], sweep: &[Entry]) -> Vec<Plot> {
    let entries: Vec<Entry> = entries.iter().chain(failures.iter().map(|failure| &failure.entry)).cloned().collect();
    let mut plots: Vec<Plot> = costs(&entries);
    let errors = |which: Integrator| -> Vec<[f64; 2]> {
        sweep.iter().filter(|e| e.integrator == which).map(|e| [e.dt, e.error.abs().max(1e-12)]).collect()
    };
    plots.push(
        Plot::new("E1: error of the slip over the step", ["step dt [s]", "relative error [-]"])
            .marks("explicit", errors(Integrator::Explicit))
            .marks("implicit", errors(Integrator::Implicit))
            .logarithmic([true; 2]),
    );
    plots
}

/// Cost over size for every model.
fn costs(entries: &[Entry]) -> Vec<Plot> {
    models(entries)
        .into_iter()
        .map(|model| {
            let times = |which: Integrator| -> Vec<[f64; 2]> {
                let entries = entries.iter().filter(|e| e.model == model && e.integrator == which);
                entries.map(|e| [e.counts[1] as f64, e.cpu]).collect()
            };
            Plot::new(format!("E1: processor time, {model}"), ["physical covers [-]", "CPU time [s]"])
                .line("explicit", times(Integrator::Explicit))
                .line("implicit", times(Integrator::Implicit))
                .logarithmic([true; 2])
        })
        .collect()
}
