//! Tessellations: cells of their size in their region, the same for a seed, with warnings and errors that say what to
//! do.

use std::path::Path;

use enmm::model::Simulation;
use enmm_io::{CaseError, LoadedCase, parse_case};

/// A square of 12 m with cells inside it.
fn text(shape: &str, size: f64, region: &str) -> String {
    format!(
        "title = \"cells\"\n[domain]\noutline = [[0, 0], [12, 0], [12, 12], [0, 12]]\njoint_law = \"bond\"\n[mesh]\n\
         size = 1.5\n[[tessellation]]\nshape = \"{shape}\"\nsize = {size:?}\nseed = 5\nregion = {region}\n\
         [rock.rock]\ndensity = 2600\nyoung = 20e9\npoisson = 0.25\n[joint_law.bond]\nfriction_deg = 40\n\
         cohesion = 5e6\nresidual_cohesion = 0\ntension = 2e6\ntension_energy = 100\nshear_energy = 1e4\n\
         [[fix]]\nedge = [[0, 0], [12, 0]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 1\n"
    )
}

fn load(text: &str) -> Result<LoadedCase, CaseError> {
    parse_case(text, "cells.toml", Path::new(""))
}

fn loaded(text: &str) -> LoadedCase {
    load(text).unwrap_or_else(|error| panic!("{error}"))
}

const ALL: &str = "[[0, 0], [12, 0], [12, 12], [0, 12]]";
const PART: &str = "[[3, 3], [9, 3], [9, 9], [3, 9]]";

#[test]
fn cells_become_blocks_of_their_size() {
    for (shape, size, area) in [("voronoi", 1.0, 0.866), ("voronoi", 2.0, 3.46), ("trigon", 1.5, 0.974)] {
        let simulation = Simulation::new(loaded(&text(shape, size, ALL)).case).expect("a model");
        let covers = &simulation.model().covers;
        let least = covers.blocks().map(|block| covers.block_area(block)).fold(f64::INFINITY, f64::min);
        let mean = 144.0 / covers.block_count() as f64;
        println!("{shape} {size}: {} blocks, mean {mean} m², least {least} m²", covers.block_count());
        // Pieces of cells at the rim count, and the smallest of them join others.
        assert!(mean < area && mean > 0.7 * area, "{shape} {size}: {mean} m²");
        assert!(least >= (1.5f64 / 20.0).powi(2), "{least} m²");
    }
}

/// Cells within a region are those of a larger one; the border of a region is joint, so that its cells are blocks.
#[test]
fn cells_do_not_depend_on_region_and_outline() {
    let inner = |region: &str, text: &dyn Fn(&str) -> String| -> Vec<[u64; 4]> {
        let case = loaded(&text(region)).case;
        let inside = |p: &[f64; 2]| p.iter().all(|x| (3.001..8.999).contains(x));
        let joints = case.joints.iter().filter(|joint| joint.points.iter().all(inside));
        let mut bits: Vec<[u64; 4]> =
            joints.map(|j| [j.points[0], j.points[1]].concat()).map(|p| [0, 1, 2, 3].map(|k| p[k].to_bits())).collect();
        bits.sort_unstable();
        bits
    };
    for shape in ["voronoi", "trigon"] {
        let plain = |region: &str| text(shape, 1.0, region);
        let wide = |region: &str| {
            plain(region).replace(
                "[[0, 0], [12, 0], [12, 12], [0, 12]]\njoint_law",
                "[[-50, -9], [90, -9], [90, 80], [-50, 80]]\njoint_law",
            )
        };
        let (all, part) = (inner(ALL, &plain), inner(PART, &plain));
        assert!(all.len() > 40 && all == part && all == inner(ALL, &wide), "{shape}: {} {}", all.len(), part.len());
        assert!(all != inner(ALL, &|region: &str| plain(region).replace("seed = 5", "seed = 6")));
        let simulation = Simulation::new(loaded(&plain(PART)).case).expect("a model");
        assert!(simulation.model().covers.block_count() > 36, "the border parts its cells from the rock around");
    }
}

#[test]
fn every_case_with_cells_says_what_they_do() {
    let warnings = |shape: &str| loaded(&text(shape, 1.0, PART)).warnings.join("\n");
    let [voronoi, trigon] = ["voronoi", "trigon"].map(warnings);
    assert!(
        voronoi.contains("tessellation[0]: cells of Voronoi interlock") && voronoi.contains("size and seed"),
        "{voronoi}"
    );
    assert!(trigon.contains("triangles shear too easily"), "{trigon}");
    assert!(voronoi.contains("do not transfer") && trigon.contains("do not transfer"));
}

#[test]
fn sizes_that_give_no_cells_are_refused_with_those_that_do() {
    let refused = |size: f64, region: &str| match load(&text("voronoi", size, region)) {
        Ok(_) => panic!("{size} m was taken"),
        Err(error) => error.to_string(),
    };
    let many = refused(0.01, ALL);
    assert!(many.contains("cells.toml:9") && many.contains("tessellation[0].size"), "{many}");
    assert!(many.contains("at most 1e5") && many.contains("raise it to 0.041 m"), "{many}");
    let crumbs = refused(0.1, PART);
    assert!(crumbs.contains("`mesh.least_block` is 5.625e-3 m²") && crumbs.contains("raise it to"), "{crumbs}");
    assert!(refused(0.0, ALL).contains("greater than 0"));
    assert!(refused(-1.0, ALL).contains("greater than 0"));
    assert!(refused(1.0, "[[0, 0], [1, 1], [2, 2]]").contains("lie on one line"));
    let law =
        load(&text("voronoi", 1.0, PART).replace("seed = 5", "seed = 5\nlaw = \"bnd\"")).expect_err("no such law");
    assert!(law.to_string().contains("tessellation[0].law") && law.to_string().contains("bond"), "{law}");
}

/// A seed of cells is a random value like any other.
#[test]
fn samples_draw_their_seeds() {
    let random = "[[random]]\nkey = \"tessellation[0].seed\"\ndistribution = \"seeds\"\nfirst = 3\n";
    assert!(load(&format!("{}{random}", text("voronoi", 1.0, PART))).is_ok());
}
