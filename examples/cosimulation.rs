//! A host in Rust: loads a case, takes communication steps, and prints where every block ends, to the last bit.
//!
//! ```text
//! cargo run --release --example cosimulation -- examples/cases/block_on_incline.toml 0.01 100
//! ```

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use enmm_io::load_case;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [case, h, steps] = words.as_slice() else {
        return Err("give three words: the case file, the communication step (s) and the number of steps".into());
    };
    let (h, steps): (f64, u32) = (h.parse()?, steps.parse()?);

    let mut model = load_case(Path::new(case))?.cosimulation()?;
    model.start()?; // The initial equilibrium; inputs would be set before.
    for k in 0..steps {
        // Here a host sets inputs (`set_block_force`, `set_water_level`, ...) and reads outputs (`port_state`).
        let info = model.do_step(f64::from(k) * h, h)?;
        for event in info.events {
            println!("# t = {:.6} s: {:?} {}", event.time, event.kind, event.subject);
        }
    }

    println!("# block, then the bits of displacement x y, rotation, velocity x y, angular velocity");
    for (id, block) in model.block_states().iter().enumerate() {
        let (u, v) = (block.displacement, block.velocity);
        let numbers = [u.x, u.y, block.rotation, v.x, v.y, block.angular_velocity];
        let bits = numbers.map(|number| format!("{:016x}", number.to_bits()));
        println!("{id} {}", bits.join(" "));
    }
    Ok(())
}
