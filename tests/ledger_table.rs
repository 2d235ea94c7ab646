//! Claim: the table of energies shows every entry of the ledger, and sums to its residual.

use enmm::internals::state::{BALANCE, ENERGIES, Ledger};

/// Every field has another power of two, so that no two sums agree by chance; so small a sum is exact.
fn distinct() -> Ledger {
    let mut ledger = serde_json::to_value(Ledger::default()).expect("a ledger");
    for (k, field) in fields(Ledger::default()).keys().enumerate() {
        *place(&mut ledger, field) = serde_json::json!(f64::exp2(k as f64));
    }
    serde_json::from_value(ledger).expect("a ledger")
}

/// A number of a ledger by its name in the table.
fn place<'a>(ledger: &'a mut serde_json::Value, field: &str) -> &'a mut serde_json::Value {
    match field.strip_prefix("bolt_") {
        Some(of_bolts) => &mut ledger["bolts"][of_bolts],
        None => &mut ledger[field],
    }
}

/// All numbers of a ledger, by their names in the table.
fn fields(ledger: Ledger) -> serde_json::Map<String, serde_json::Value> {
    let mut all = serde_json::to_value(ledger).expect("a ledger").as_object().expect("fields").clone();
    let bolts = all.remove("bolts").expect("energies of bolts");
    all.extend(bolts.as_object().expect("fields").iter().map(|(name, of)| (format!("bolt_{name}"), of.clone())));
    all
}

#[test]
fn the_table_sums_to_the_residual_and_shows_every_field() {
    let ledger = distinct();
    let get = |name: &str| {
        let found = ENERGIES.iter().find(|energy| energy.name == name);
        (found.unwrap_or_else(|| panic!("{name} is not in the table")).get)(&ledger)
    };
    let sum: f64 = BALANCE.iter().map(|(name, sign)| sign * get(name)).sum();
    assert_eq!(sum, ledger.residual());
    for (field, value) in fields(ledger) {
        assert_eq!(Some(get(&field)), value.as_f64(), "{field}");
    }
}

/// A residual is small or large beside any energy that forces have moved: the work of supports was left out.
#[test]
fn every_energy_that_moves_counts_as_the_largest() {
    let fields = fields(Ledger::default());
    let largest = |field: &str| {
        let mut one = serde_json::to_value(Ledger::default()).expect("a ledger");
        *place(&mut one, field) = serde_json::json!(-3.0);
        serde_json::from_value::<Ledger>(one).expect("a ledger").largest()
    };
    let still: Vec<&str> = fields.keys().map(String::as_str).filter(|field| largest(field) != 3.0).collect();
    assert_eq!(still, ["baseline", "bolt_installed"]);
    assert!(fields.contains_key("support_work") && fields.len() == 16);
}

#[test]
fn names_in_the_table_are_their_own() {
    for names in [ENERGIES.map(|energy| energy.name), ENERGIES.map(|energy| energy.column)] {
        let own: std::collections::BTreeSet<&str> = names.into_iter().collect();
        assert_eq!(own.len(), ENERGIES.len());
    }
}
