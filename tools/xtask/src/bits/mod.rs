//! Which bits results have: those of two builds beside each other, or those of this build beside the golden table.

mod golden;
mod item;
mod platform;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

use crate::counts::Counts;
use crate::emulator::Emulator;
use crate::platform::{HERE, Platform};
use crate::repository::{self, Repository};
use golden::Golden;
use item::{Act, ITEMS, Item, Maker};
pub use item::{has_folder, host_words, library};

/// Contents by name.
type Results = BTreeMap<String, Vec<u8>>;

const USAGE: &str = "usage: cargo xtask bits [OLD NEW] [--quick], or cargo xtask bits --renew";

/// Reads `[OLD NEW] [--quick]` or `--renew`, and does it.
///
/// # Errors
/// When the words are others, an item does not run, or bits differ.
pub fn run(repository: &Repository, words: &[&str]) -> Result<(), String> {
    if let [old, new, rest @ ..] = words {
        let programs = [old, new].map(|path| repository::program(path.as_ref()));
        return match rest {
            [] => compare(repository, programs, |_| true),
            ["--quick"] => compare(repository, programs, |item| item.quick),
            _ => Err(USAGE.to_owned()),
        };
    }
    let act: fn(&Repository) -> Result<(), String> = match words {
        [] => |repository| all_good(against_golden(repository, |_| true)?),
        ["--quick"] => |repository| all_good(quick(repository)?),
        ["--renew"] => renew,
        _ => return Err(USAGE.to_owned()),
    };
    repository.build(&["--workspace"])?;
    act(repository)
}

/// Prints how many results are as in the golden table.
pub fn all_good(counts: Counts) -> Result<(), String> {
    println!("{} as in the golden table, {} others", counts.passed, counts.failed);
    if counts.failed == 0 { Ok(()) } else { Err(format!("{} results have other bits: see above", counts.failed)) }
}

/// The items that `cargo xtask test` compares with the golden table.
pub fn quick(repository: &Repository) -> Result<Counts, String> {
    against_golden(repository, |item| item.quick)
}

/// Runs items by both programs in turn, up to the first difference.
fn compare(repository: &Repository, [old, new]: [PathBuf; 2], chosen: impl Fn(&Item) -> bool) -> Result<(), String> {
    let folder = repository::fresh(repository.target.join("bits"))?;
    // Cases of models are written by one of the two, so that both compute the same ones.
    let here = Emulator::default();
    let makers = [(&old, "old"), (&new, "new")]
        .map(|(program, name)| Maker { writer: &new, ..own(repository, program, folder.join(name), &here) });
    println!("| item | result | old | new |\n|---|---|---|---|");
    for item in ITEMS.iter().filter(|item| chosen(item)) {
        let [old, new] = [makers[0].make(item)?, makers[1].make(item)?];
        let [of_old, of_new] = [&old, &new].map(golden::hashes);
        let names: BTreeSet<&String> = of_old.keys().chain(of_new.keys()).collect();
        for name in names {
            let hash = |hashes: &BTreeMap<String, String>| hashes.get(name).map_or("–", |hash| &hash[..12]).to_owned();
            println!("| {} | {name} | {} | {} |", item.name, hash(&of_old), hash(&of_new));
        }
        if let Some(difference) = first_difference(&old, &new) {
            return Err(format!("{}: {difference}; both are in {}", item.name, folder.display()));
        }
        makers.iter().try_for_each(|maker| maker.forget(item))?;
    }
    println!("all bits are the same");
    Ok(())
}

/// Compares the quick items by the build for another platform with the golden table, but for [`item::LONG_EMULATED`].
/// `host` runs its FMUs.
pub fn elsewhere(
    repository: &Repository,
    platform: &Platform,
    emulator: &Emulator,
    host: &Path,
) -> Result<Counts, String> {
    let program = platform.shipped(repository).join(platform.program());
    let (folder, writer) = (repository::fresh(repository.target.join("bits"))?, repository.enmm());
    let maker = Maker { repository, platform, emulator, host: Some(host), program: &program, writer: &writer, folder };
    let runs = |item: &&Item| item.version().is_none_or(|version| has_folder(platform, version));
    let chosen = |item: &&Item| item.quick && item.name != item::LONG_EMULATED && runs(item);
    beside_golden(&Golden::read(&repository.root)?, &maker, ITEMS.iter().filter(chosen))
}

/// Runs items by this build and compares with the golden table. Verification problems are left out, with a message,
/// where the mathematical functions of the system, which they use, are others.
fn against_golden(repository: &Repository, chosen: impl Fn(&Item) -> bool) -> Result<Counts, String> {
    let golden = Golden::read(&repository.root)?;
    let other = golden.other_platform();
    // Cases of verification problems are made by the mathematical functions of the system.
    let is_left_out = |item: &Item| other.is_some() && matches!(item.act, Act::Verify(_));
    if let Some(reason) = &other
        && ITEMS.iter().any(|item| chosen(item) && is_left_out(item))
    {
        println!("verification problems are not compared: {reason}; `cargo xtask bits OLD NEW` holds anywhere");
    }
    let (folder, program) = (repository::fresh(repository.target.join("bits"))?, repository.enmm());
    let here = Emulator::default();
    let maker = own(repository, &program, folder, &here);
    beside_golden(&golden, &maker, ITEMS.iter().filter(|item| item.golden && chosen(item) && !is_left_out(item)))
}

/// Makes results by this build.
fn own<'a>(repository: &'a Repository, program: &'a Path, folder: PathBuf, emulator: &'a Emulator) -> Maker<'a> {
    Maker { repository, platform: &HERE, emulator, host: None, program, writer: program, folder }
}

/// Two items at a time: most of an item keeps one processor busy.
fn beside_golden<'a>(golden: &Golden, maker: &Maker, items: impl Iterator<Item = &'a Item>) -> Result<Counts, String> {
    let items = Mutex::new(items.collect::<Vec<_>>().into_iter());
    let next = || items.lock().ok().and_then(|mut items| items.next());
    let work = || {
        let mut counts = Counts::default();
        while let Some(item) = next() {
            counts += item_beside_golden(golden, maker, item)?;
        }
        Ok(counts)
    };
    let [first, second]: [Result<Counts, String>; 2] = std::thread::scope(|scope| {
        let other = scope.spawn(work);
        [work(), other.join().unwrap_or_else(|_| Err("a comparison panicked".to_owned()))]
    });
    let mut counts = first?;
    counts += second?;
    if counts.failed > 0 {
        println!(
            "results have changed: `cargo xtask bits OLD NEW` names the first difference between two builds; where it \
             is meant, `cargo xtask bits --renew` and a line in CHANGELOG.md"
        );
    }
    Ok(counts)
}

fn item_beside_golden(golden: &Golden, maker: &Maker, item: &Item) -> Result<Counts, String> {
    let start = Instant::now();
    let found = golden::hashes(&maker.make(item)?);
    maker.forget(item)?;
    let seconds = start.elapsed().as_secs_f64();
    let problems = golden.problems(item.name, &found);
    let differ = if problems.is_empty() { "as they were" } else { "OTHER BITS" };
    let mut lines = format!("{:<24} {:>2} results {seconds:>6.1} s  {differ}", item.name, found.len());
    problems.iter().for_each(|problem| lines += &format!("\n  {problem}"));
    println!("{lines}");
    let failed = problems.len() as u64;
    Ok(Counts { passed: (found.len() as u64).saturating_sub(failed), failed, ..Counts::default() })
}

/// Renews the golden table.
fn renew(repository: &Repository) -> Result<(), String> {
    let (folder, program) = (repository::fresh(repository.target.join("bits"))?, repository.enmm());
    let here = Emulator::default();
    let maker = own(repository, &program, folder, &here);
    let mut golden = Golden::here();
    for item in ITEMS.iter().filter(|item| item.golden) {
        println!("{} …", item.name);
        golden.take(item.name, golden::hashes(&maker.make(item)?));
        maker.forget(item)?;
    }
    golden.write(&repository.root)?;
    println!("wrote {}", golden::PLACE);
    Ok(())
}

/// Where two results are not the same first: a name that one of them lacks, or a place in a file.
fn first_difference(old: &Results, new: &Results) -> Option<String> {
    let lacks = |a: &Results, b: &Results| a.keys().find(|name| !b.contains_key(*name)).cloned();
    if let Some(name) = lacks(old, new) {
        return Some(format!("{name} is missing in the new results"));
    }
    if let Some(name) = lacks(new, old) {
        return Some(format!("{name} is missing in the old results"));
    }
    let (name, old, new) = old.iter().map(|(name, old)| (name, old, &new[name])).find(|(_, old, new)| old != new)?;
    let at = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let line = 1 + old[..at].iter().filter(|&&byte| byte == b'\n').count();
    let size = if old.len() == new.len() { String::new() } else { format!(" ({} and {} bytes)", old.len(), new.len()) };
    let lines = [old, new].map(|bytes| std::str::from_utf8(bytes).ok().map(|text| excerpt(text, at)));
    Some(match lines {
        [Some(old), Some(new)] => format!("{name} differs{size} in line {line}: {old:?} became {new:?}"),
        _ => format!("{name} differs{size} from byte {at} on"),
    })
}

/// Text around a place, within its line.
fn excerpt(text: &str, at: usize) -> String {
    const AROUND: usize = 24;
    let start =
        text[..floor(text, at)].rfind('\n').map_or(0, |end| end + 1).max(floor(text, at.saturating_sub(AROUND)));
    text[start..].lines().next().unwrap_or_default().chars().take(3 * AROUND).collect()
}

/// The start of the letter that a byte belongs to.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&k| text.is_char_boundary(k)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repository::Profile;

    fn results(files: &[(&str, &str)]) -> Results {
        files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect()
    }

    #[test]
    fn the_first_difference_is_named() {
        let old = results(&[("a.csv", "x\n1.0\n"), ("b.csv", "y\nµ 2.0\n")]);
        assert_eq!(first_difference(&old, &old), None);
        let last_digit = results(&[("a.csv", "x\n1.0\n"), ("b.csv", "y\nµ 2.1\n")]);
        let told = first_difference(&old, &last_digit).expect("a difference");
        assert_eq!(told, "b.csv differs in line 2: \"µ 2.0\" became \"µ 2.1\"");
        let fewer = first_difference(&old, &results(&[("a.csv", "x\n1.0\n")])).expect("a difference");
        assert_eq!(fewer, "b.csv is missing in the new results");
        let longer = results(&[("a.csv", "x\n1.0\n"), ("b.csv", "y\nµ 2.0\n\n")]);
        assert!(first_difference(&old, &longer).is_some_and(|told| told.contains("bytes")));
    }

    #[test]
    fn the_table_of_the_repository_has_the_items() {
        let golden = Golden::read(&Repository::find(Profile::Shipped).expect("the repository").root).expect("a table");
        let items: BTreeSet<&str> = ITEMS.iter().filter(|item| item.golden).map(|item| item.name).collect();
        assert_eq!(golden.items().collect::<BTreeSet<_>>(), items, "run `cargo xtask bits --renew`");
    }
}
