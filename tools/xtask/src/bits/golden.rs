//! The golden table: a hash for every result of every item, and the platform that verification problems were solved on.

use std::collections::BTreeMap;
use std::path::Path;

use sha1_smol::Sha1;

use super::{Results, platform};

/// Where the table is.
pub const PLACE: &str = "tests/golden/bits.csv";
const HEADER: &str = "item,result,sha1";
/// Item of the row that names the platform.
const PLATFORM: &str = "platform";

/// The table.
#[derive(Debug, PartialEq)]
pub struct Golden {
    /// Name of the platform, and hash of its mathematical functions.
    platform: [String; 2],
    /// Hashes by item and result.
    rows: BTreeMap<String, BTreeMap<String, String>>,
}

impl Golden {
    /// A table without rows, for this platform.
    pub fn here() -> Self {
        Self { platform: [platform::name(), platform::functions()], rows: BTreeMap::new() }
    }

    /// Reads the table of the repository.
    pub fn read(root: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(root.join(PLACE)).map_err(|error| format!("{PLACE}: {error}"))?;
        Self::parse(&text).ok_or_else(|| format!("{PLACE} is no golden table: `cargo xtask bits --renew` writes one"))
    }

    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        (lines.next()? == HEADER).then_some(())?;
        let mut rows = lines.map(|line| {
            let mut cells = line.split(',').map(str::to_owned);
            let row = [cells.next()?, cells.next()?, cells.next()?];
            cells.next().is_none().then_some(row)
        });
        let [first, name, functions] = rows.next()??;
        (first == PLATFORM).then_some(())?;
        let mut golden = Self { platform: [name, functions], rows: BTreeMap::new() };
        for row in rows {
            let [item, result, hash] = row?;
            golden.rows.entry(item).or_default().insert(result, hash);
        }
        Some(golden)
    }

    fn text(&self) -> String {
        let [name, functions] = &self.platform;
        let mut text = format!("{HEADER}\n{PLATFORM},{name},{functions}\n");
        for (item, results) in &self.rows {
            results.iter().for_each(|(result, hash)| text += &format!("{item},{result},{hash}\n"));
        }
        text
    }

    /// Writes the table into the repository.
    pub fn write(&self, root: &Path) -> Result<(), String> {
        std::fs::write(root.join(PLACE), self.text()).map_err(|error| format!("{PLACE}: {error}"))
    }

    /// Why verification problems have other bits here; none where they have those of the table.
    pub fn other_platform(&self) -> Option<String> {
        let [name, functions] = &self.platform;
        let here = platform::name();
        if *name != here {
            return Some(format!("those of the table are of {name}, this is {here}"));
        }
        let other = *functions != platform::functions();
        other.then(|| format!("the mathematical functions (sin, exp, …) of this {here} end in other bits"))
    }

    /// Names of the items.
    #[cfg(test)]
    pub fn items(&self) -> impl Iterator<Item = &str> {
        self.rows.keys().map(String::as_str)
    }

    /// Takes the hashes of an item in.
    pub fn take(&mut self, item: &str, hashes: BTreeMap<String, String>) {
        self.rows.insert(item.to_owned(), hashes);
    }

    /// Differences of an item from the table.
    pub fn problems(&self, item: &str, found: &BTreeMap<String, String>) -> Vec<String> {
        let nothing = BTreeMap::new();
        let known = self.rows.get(item).unwrap_or(&nothing);
        let mut problems: Vec<String> = known.keys().filter(|name| !found.contains_key(*name)).cloned().collect();
        problems.iter_mut().for_each(|name| *name += ": missing");
        for (name, hash) in found {
            match known.get(name) {
                Some(other) if other == hash => {}
                Some(other) => problems.push(format!("{name}: {} became {}", &other[..12], &hash[..12])),
                None => problems.push(format!("{name}: not in the table")),
            }
        }
        problems
    }
}

/// A hash for each result; frames and pictures have one together.
pub fn hashes(results: &Results) -> BTreeMap<String, String> {
    let mut sums: BTreeMap<String, Sha1> = BTreeMap::new();
    for (name, bytes) in results {
        let sum = sums.entry(kind(name).to_owned()).or_default();
        // Names and lengths count as well, so that bytes cannot wander from one file to the next.
        sum.update(format!("{name} {}\n", bytes.len()).as_bytes());
        sum.update(bytes);
    }
    sums.into_iter().map(|(kind, sum)| (kind, sum.digest().to_string())).collect()
}

/// Kind of a file.
fn kind(name: &str) -> &str {
    match name {
        _ if name.ends_with(".vtu") || name.ends_with(".pvd") => "frames",
        _ if name.ends_with(".png") => "pictures",
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(bytes: &str) -> BTreeMap<String, String> {
        let names = ["frames/elements_0000.vtu", "frames/joints_0000.vtu", "blocks.csv"];
        hashes(&names.map(|name| (name.to_owned(), bytes.as_bytes().to_vec())).into())
    }

    #[test]
    fn the_table_is_read_back_and_sees_a_change() {
        let mut golden = Golden::here();
        golden.take("slope", found("1.0"));
        assert_eq!(Golden::parse(&golden.text()).as_ref(), Some(&golden));
        assert_eq!(golden.other_platform(), None);
        assert!(golden.problems("slope", &found("1.0")).is_empty());
        assert_eq!(golden.problems("slope", &found("1.1")).len(), 2, "blocks.csv and frames");
        assert_eq!(golden.problems("slope", &BTreeMap::new()).len(), 2);
        assert_eq!(golden.problems("other", &found("1.0")).len(), 2);
    }

    #[test]
    fn another_platform_is_told_and_another_file_refused() {
        let mut golden = Golden::here();
        golden.platform[1].replace_range(..1, "-");
        assert!(golden.other_platform().is_some_and(|told| told.contains("sin")));
        golden.platform[0] = "elsewhere".to_owned();
        assert!(golden.other_platform().is_some_and(|told| told.contains("elsewhere")));
        for text in ["", "item,result,sha1\n", "item,result,sha1\nslope,frames,0\n", "a,b\n"] {
            assert_eq!(Golden::parse(text), None, "{text:?}");
        }
    }
}
