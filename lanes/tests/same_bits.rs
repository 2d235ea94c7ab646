//! Every kind of lanes gives the bits of the portable one, operation by operation.

use enmm_lanes::{Kernel, LANES, Lanes, Pair, Path, SLOTS, Slot, Table, dispatch_on};

/// Numbers of all sizes and both signs, and a zero.
fn numbers(seed: u64) -> [f64; LANES] {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    std::array::from_fn(|k| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let unit = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
        if k == 3 { 0.0 } else { unit * 10f64.powi((state % 21) as i32 - 10) }
    })
}

/// All operations, one after the other.
struct Everything(u64);

impl Kernel for Everything {
    type Output = Vec<u64>;

    fn run<L: Lanes>(self, lanes: L) -> Vec<u64> {
        let (a, b) = (lanes.load(&numbers(self.0)), lanes.load(&numbers(self.0 + 1)));
        let [pairs, some] = [0, 1].map(|k| {
            let (x, y) = (numbers(self.0 + k), numbers(self.0 + k + 2));
            std::array::from_fn::<Pair, LANES, _>(|i| Pair::new(x[i], y[i]))
        });
        let [x, y] = lanes.load_pairs(&pairs);
        let [z, w] = lanes.load_some_pairs(&some[..5], Pair::new(1.0, -2.0));
        let part = lanes.load_some(&numbers(self.0)[..3], 7.0);
        let mut table = Table::default();
        for (k, pair) in table.first_mut(40).iter_mut().enumerate() {
            *pair = pairs[k % LANES] * (k as f64 + 0.1);
        }
        let slots = [3, 1, 4, 1, 5, 39, 2, 6].map(Slot::new);
        lanes.scatter_add(&mut table, &slots, [x, b]);
        for run in [[SLOTS - 1, 3], [4, SLOTS - 1], [9, 13]] {
            let last = lanes.scatter_triangles(&mut table, run.map(Slot::new), [a, y], [b, x]);
            table.add_beside(Slot::new(run[0]), last);
        }
        let [g, h] = lanes.gather(&table, &slots);
        let [[i, j], [k, l]] = lanes.gather_triangles(&table, [7, SLOTS - 1].map(Slot::new));
        let mut stored = [Pair::zeros(); 6];
        lanes.store_some_pairs([z, w], &mut stored);
        let one = lanes.splat(1.0);
        let list = [
            a + b,
            a - b,
            a * b,
            a / (b * b + one),
            -a,
            lanes.sqrt(a * a),
            lanes.max(a, b),
            x,
            y,
            z,
            w,
            part,
            g,
            h,
            i,
            j,
            k,
            l,
        ];
        let mut bits = Vec::new();
        for value in list {
            let mut out = [0.0; LANES];
            lanes.store(value, &mut out);
            bits.extend(out.map(f64::to_bits));
            bits.extend([lanes.sum(value), lanes.greatest(value)].map(f64::to_bits));
        }
        let masks = [(a, b), (b, a), (a, a), (x, w), (lanes.sqrt(-a), b)].map(|(a, b)| lanes.at_most(a, b));
        bits.extend(masks.map(u64::from));
        let pairs = table.first(SLOTS).iter().chain(&stored);
        bits.extend(pairs.flat_map(|p| [p.x.to_bits(), p.y.to_bits()]));
        lanes.clear(&mut table, 13);
        bits.extend(table.first(40).iter().flat_map(|p| [p.x.to_bits(), p.y.to_bits()]));
        bits
    }
}

#[test]
fn all_paths_give_the_bits_of_the_portable_one() {
    for seed in 0..200 {
        let expected = dispatch_on(Path::Portable, Everything(seed));
        for path in Path::all() {
            assert!(dispatch_on(path, Everything(seed)) == expected, "{} at {seed}", path.name());
        }
    }
}

#[test]
#[should_panic(expected = "slot 4096")]
fn a_slot_outside_the_table_is_refused() {
    Slot::new(SLOTS);
}
