//! Claim: an infinite number anywhere in the bytes of a saved state, with a good checksum, is refused when they are
//! read, or stands where it means something else; no getter and no step panics or gives an infinite value afterwards.

use std::path::Path;

use enmm::model::bytes;
use enmm_fmi::instance::{Instance, Plan};
use enmm_fmi::log::Status;
use enmm_fmi::resource;
use enmm_fmi::table::{Causality, Table, Type, Variable, Version};
use enmm_io::load_case;
use serde::Serialize;
use serde::ser::{SerializeTuple, Serializer};

/// Bytes that are written as they are.
struct Raw<'a>(&'a [u8]);

impl Serialize for Raw<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        self.0.iter().try_for_each(|byte| tuple.serialize_element(byte))?;
        tuple.end()
    }
}

/// An instance in step mode, three hundredths of a second after its start.
fn instance(version: Version, folder: &Path) -> Instance {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let loaded = load_case(&root.join("examples/cases/block_on_incline.toml")).unwrap();
    std::fs::write(folder.join(resource::FILE), resource::encode(&loaded, "incline").unwrap()).unwrap();
    let blocks = loaded.cosimulation().unwrap().blocks_max();
    let token = Table::new(&loaded.case, blocks, &loaded.hash, version).token;
    let plan = Plan {
        version,
        name: "a",
        token: &token,
        resources: folder,
        logging: false,
        early_return: false,
        event_mode: false,
    };
    let mut instance = Instance::new(plan).unwrap();
    assert_eq!(instance.enter_initialization(Some((0.0, None))), Status::Ok);
    assert_eq!(instance.exit_initialization(), Status::Ok);
    assert_eq!(step(&mut instance), Status::Ok);
    instance
}

/// Three internal steps and a half.
fn step(instance: &mut Instance) -> Status {
    let h = 3.5 * instance.model().internal_step();
    let mut step = match instance.begin_step(instance.time(), h) {
        Ok(step) => step,
        Err(status) => return status,
    };
    let mut status = Status::Ok;
    while status == Status::Ok && !step.is_done() {
        status = instance.advance_step(&mut step);
    }
    status
}

/// Values of all outputs that are numbers, without the net force over an applied one that may be next to nothing.
fn outputs(instance: &mut Instance) -> Vec<f64> {
    let is_output =
        |v: &&Variable| v.causality == Causality::Output && v.kind == Type::Real && v.name != "unbalanced_ratio";
    let list: Vec<_> = instance.table().variables.iter().filter(is_output).map(|v| (v.reference, v.size())).collect();
    let mut values = vec![0.0; list.iter().map(|(_, size)| size).sum()];
    let references: Vec<u32> = list.iter().map(|(reference, _)| *reference).collect();
    assert_eq!(instance.get(&references, Type::Real, &mut values), Status::Ok);
    values
}

#[test]
fn infinite_numbers_in_saved_states_are_refused_or_do_no_harm() {
    for version in [Version::Two, Version::Three] {
        let folder = tempfile::tempdir().unwrap();
        let mut instance = instance(version, folder.path());
        let token = instance.table().token.clone();
        let good = instance.save_state(None).unwrap();
        let bytes = instance.serialize_state(good).unwrap().to_vec();
        let start = bytes::encode(bytes::Keeper::Fmu, &Raw(&[]), &token).unwrap().len();
        let (mut refused, mut named) = (0, 0);
        for at in start..bytes.len() - 8 {
            let mut payload = bytes[start..].to_vec();
            payload[at - start..at - start + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
            let forged = bytes::encode(bytes::Keeper::Fmu, &Raw(&payload), &token).unwrap();
            instance.take_messages();
            match instance.deserialize_state(&forged, None) {
                Err(status) => {
                    assert_eq!(status, Status::Error);
                    refused += 1;
                    named += usize::from(instance.take_messages()[0].text.contains("must be"));
                }
                Ok(state) => {
                    assert_eq!(instance.restore_state(state), Status::Ok, "byte {at}");
                    assert!(outputs(&mut instance).iter().all(|value| value.is_finite()), "byte {at}");
                    assert!(matches!(step(&mut instance), Status::Ok | Status::Discard | Status::Error), "byte {at}");
                    assert_eq!(instance.free_state(state), Status::Ok);
                }
            }
        }
        assert!(4 * refused > bytes.len() && 5 * named > bytes.len(), "{refused}, {named} of {}", bytes.len());
        assert_eq!(instance.restore_state(good), Status::Ok);
        assert_eq!(step(&mut instance), Status::Ok, "the instance goes on");
    }
}
