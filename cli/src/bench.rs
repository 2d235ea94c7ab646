//! `enmm bench`: throughput on standard models.

use std::process::ExitCode;

use enmm::io::bench::{Throughput, bench};

use crate::{FAILED, fail, print_line};

/// Wall time (s) for each model.
const SECONDS: f64 = 3.0;

/// Times the standard models and prints what they reach.
pub fn run(json: bool) -> ExitCode {
    let found = match bench(SECONDS) {
        Ok(found) => found,
        Err(error) => return fail(&error, FAILED),
    };
    if json {
        print_line(&format!("{:#}", serde_json::json!({ "models": found })));
    } else {
        found.iter().for_each(|throughput| print_line(&table(throughput)));
    }
    ExitCode::SUCCESS
}

fn table(found: &Throughput) -> String {
    let Throughput { model, threads, blocks, elements, contacts, shares, .. } = found;
    let contacts_rate =
        found.contacts_per_second.map_or_else(|| "–".to_owned(), |rate| format!("{:.2} M/s", rate / 1e6));
    let parts = [
        ("elements", shares.elements),
        ("search", shares.search),
        ("entrance", shares.entrance),
        ("sweep", shares.sweep),
        ("commit", shares.commit),
        ("rest", shares.rest),
    ];
    let parts: Vec<String> = parts.iter().map(|(name, share)| format!("{name} {:.1} %", 100.0 * share)).collect();
    [
        format!("{model}: {blocks} blocks, {elements} elements, {contacts} contacts, {threads} threads"),
        format!("  steps             {:.1} /s ({:.2} sweeps each)", found.steps_per_second, found.sweeps_mean),
        format!("  element updates   {:.2} M/s", found.element_updates_per_second / 1e6),
        format!("  contacts judged   {contacts_rate}"),
        format!("  shares            {}", parts.join(", ")),
    ]
    .join("\n")
}
