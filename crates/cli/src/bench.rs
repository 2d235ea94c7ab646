//! `enmm bench`: what standard models cost.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use enmm_io::files::write_atomic;
use enmm_run::make_place;
use enmm_verification::bench::{
    BenchOptions, BenchReport, LARGE, Measured, Model, Origin, REPORT_FILES, STANDARD, bench, write_report,
};

use crate::{BAD_INPUT, FAILED, OrFail, Outcome, print_line, tell_line};

/// Models to time, and options.
#[derive(clap::Args)]
pub struct Arguments {
    /// Models by name, separated by commas: continuum_N, fractured_resting, fractured_failing, slope_NxM (N blocks of M
    /// elements); or `all`. Default: those that take less than a minute together.
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    models: Vec<String>,
    /// Wall time for the steps of each model (s).
    #[arg(long, default_value_t = 2.0)]
    seconds: f64,
    /// Threads; default: all.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Leave out the limits of the machine.
    #[arg(long)]
    no_limits: bool,
    /// Run slopes that stand beside other programs through their first second as well, which takes minutes.
    #[arg(long)]
    first_second: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write the case files of the models there and time nothing.
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,
    /// Directory for tables (Markdown and JSON) and plots.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Label of these results, such as commit and date.
    #[arg(long, default_value = "Measured", value_name = "TEXT")]
    label: String,
}

/// Times models and prints what they cost.
pub fn run(arguments: &Arguments) -> Outcome {
    let unknown = |name: &str| format!("there is no model {name:?}: try {}, or all", names(&STANDARD));
    let models = models(&arguments.models).map_err(unknown).or_fail(BAD_INPUT)?;
    if let Some(folder) = &arguments.write {
        return write_cases(&models, folder);
    }
    if let Some(folder) = &arguments.output {
        make_place(folder, &REPORT_FILES).or_fail(BAD_INPUT)?;
    }
    let options = BenchOptions {
        models,
        seconds: arguments.seconds,
        threads: arguments.threads.map(usize::from),
        limits: !arguments.no_limits,
        first_second: arguments.first_second,
    };
    let mut begin = |name: &str| {
        if !arguments.json {
            tell_line(&format!("{name} …"));
        }
    };
    let report = bench(&options, &mut begin).or_fail(FAILED)?;
    let origin = Origin::of(&arguments.label, "enmm", std::env::args().skip(1));
    let written = arguments.output.as_ref().map_or(Ok(()), |folder| write_report(&report, &origin, folder));
    print_line(&if arguments.json { format!("{:#}", serde_json::json!(report)) } else { text(&report) });
    written.map(|()| ExitCode::SUCCESS).or_fail(FAILED)
}

/// Writes the case of each model into a file of its name.
fn write_cases(models: &[Model], folder: &Path) -> Outcome {
    let write = || -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        models.iter().try_for_each(|model| {
            let path = folder.join(format!("{model}.toml"));
            write_atomic(&path, model.text().as_bytes())?;
            print_line(&path.display().to_string());
            Ok(())
        })
    };
    let refused = |error| format!("cannot write to {} ({error}): choose another directory", folder.display());
    write().map(|()| ExitCode::SUCCESS).map_err(refused).or_fail(BAD_INPUT)
}

fn models(names: &[String]) -> Result<Vec<Model>, &str> {
    if names.is_empty() {
        return Ok(STANDARD.to_vec());
    }
    if names == ["all"] {
        return Ok(STANDARD.into_iter().chain(LARGE).collect());
    }
    names.iter().map(|name| Model::parse(name).ok_or(name.as_str())).collect()
}

fn names(models: &[Model]) -> String {
    models.iter().map(Model::to_string).collect::<Vec<_>>().join(", ")
}

fn text(report: &BenchReport) -> String {
    let machine = &report.machine;
    let processor = machine.processor.as_deref().unwrap_or("unknown processor");
    let mut lines = vec![format!(
        "enmm {}, {processor}, {} cores, {}; {} threads",
        report.version,
        machine.cores,
        machine.caches.join(", "),
        report.threads
    )];
    for level in &machine.bandwidth {
        lines.push(format!(
            "  {:<5} {:7.1} GB/s one thread, {:7.1} all",
            level.level,
            level.one / 1e9,
            level.all / 1e9
        ));
    }
    if let Some([one, all]) = machine.multiply_add {
        lines.push(format!("  FMA   {:7.1} GFLOP/s one thread, {:5.1} all", one / 1e9, all / 1e9));
    }
    lines.extend(report.models.iter().map(model_text));
    lines.join("\n")
}

fn model_text(found: &Measured) -> String {
    let Measured { model, blocks, elements, contacts, .. } = found;
    let share = |share: Option<f64>| share.map_or_else(|| "–".to_owned(), |share| format!("{:.0} %", 100.0 * share));
    let stages = found.stages.named();
    let parts = stages.map(|(name, ms)| format!("{name} {ms:.3} ({:.0} %)", 100.0 * ms / found.ms_per_step));
    let sweeps = found.contact_sweeps_per_second.map_or_else(String::new, |rate| {
        format!(", {:.2} sweeps at {:.1} M contacts/s", found.sweeps_mean, rate / 1e6)
    });
    let heaps = found.heap_bytes.map(|bytes| format!("{:.0}", bytes as f64 / *elements as f64)).join(" + ");
    let first = found.first_second.map_or_else(String::new, |seconds| format!(", the first one {seconds:.3} s"));
    let memory = found.memory_peak.map_or_else(String::new, |peak| format!(", peak {:.0} MB", peak as f64 / 1e6));
    [
        format!("{model}: {blocks} blocks, {elements} elements ({} held), {contacts} contacts", found.held_elements),
        format!(
            "  {:.3} ms a step (median of wall time {:.3}), {:.3} s a simulated second{first}{sweeps}",
            found.ms_per_step, found.wall_ms_per_step, found.seconds_per_simulated_second
        ),
        format!("  ms: {}", parts.join(", ")),
        format!(
            "  elements {:.1} M/s, step {:.2} M/s; {:.0} B and {:.0} operations each: {} of bandwidth, {} of FMA",
            found.elements_per_second / 1e6,
            found.step_elements_per_second / 1e6,
            found.bytes_per_element,
            found.operations_per_element,
            share(found.share_of_bandwidth),
            share(found.share_of_operations)
        ),
        format!(
            "  {} searches of {:.3} ms; frame {:.1} ms, checkpoint {:.1} ms; built in {:.2} s{memory}, {heaps} B each",
            found.searches,
            found.ms_per_search.unwrap_or(0.0),
            found.frame_ms,
            found.checkpoint_ms,
            found.build_seconds
        ),
    ]
    .join("\n")
}
