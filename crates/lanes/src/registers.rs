//! What registers have in common, however many of them hold eight values.

/// A proof that the processor has some instructions, values in registers of these, and the operations that treat all
/// registers alike or read and write pairs one by one. A file that makes them has functions `keep_above`, `at_most`,
/// `select`, `eight` and `apart`.
macro_rules! registers {
    (
        $proof:ident, $values:ident [$register:ty; $($k:literal)*] by $of:literal:
        $set:ident $load:ident $store:ident $sqrt:ident $max:ident $min:ident
        $add:ident $sub:ident $mul:ident $div:ident
    ) => {
        /// Proof that the processor has these instructions: only [`run`] makes one.
        #[derive(Clone, Copy)]
        pub struct $proof(());

        /// Eight values; only the proof makes them, so that one at hand proves the instructions as well.
        #[derive(Clone, Copy)]
        pub struct $values([$register; LANES / WIDTH]);

        /// Values of a register.
        const WIDTH: usize = size_of::<$register>() / size_of::<f64>();

        /// Runs a kernel with lanes of this kind.
        ///
        /// # Safety
        /// The processor must have these instructions.
        #[target_feature(enable = $of)]
        pub unsafe fn run<K: Kernel>(kernel: K) -> K::Output {
            kernel.run($proof(()))
        }

        registers!(Add, add, $add, $values, $($k)*);
        registers!(Sub, sub, $sub, $values, $($k)*);
        registers!(Mul, mul, $mul, $values, $($k)*);
        registers!(Div, div, $div, $values, $($k)*);

        impl Arithmetic for $values {
            #[inline(always)]
            fn splat(self, value: f64) -> Self {
                $proof(()).splat(value)
            }
        }

        impl Values for $proof {
            type F = $values;

            #[inline(always)]
            fn splat(self, value: f64) -> $values {
                // SAFETY: the token proves the instructions.
                $values(unsafe { [$set(value); LANES / WIDTH] })
            }

            #[inline(always)]
            fn load(self, values: &[f64; LANES]) -> $values {
                let at = values.as_ptr();
                // SAFETY: the token proves the instructions; the array holds eight values.
                $values(unsafe { [$($load(at.add($k * WIDTH))),*] })
            }

            #[inline(always)]
            fn store(self, lanes: $values, out: &mut [f64; LANES]) {
                let at = out.as_mut_ptr();
                // SAFETY: the token proves the instructions; the array holds eight values.
                unsafe { $($store(at.add($k * WIDTH), lanes.0[$k]);)* }
            }

            #[inline(always)]
            fn max(self, a: $values, b: $values) -> $values {
                // SAFETY: the token proves the instructions.
                $values(unsafe { [$($max(a.0[$k], b.0[$k])),*] })
            }

            #[inline(always)]
            fn min(self, a: $values, b: $values) -> $values {
                // SAFETY: the token proves the instructions.
                $values(unsafe { [$($min(a.0[$k], b.0[$k])),*] })
            }

            #[inline(always)]
            fn sqrt(self, lanes: $values) -> $values {
                // SAFETY: the token proves the instructions.
                $values(unsafe { [$($sqrt(lanes.0[$k])),*] })
            }

            #[inline(always)]
            fn keep_above(self, values: $values, others: $values, limit: $values) -> $values {
                keep_above(self, values, others, limit)
            }

            #[inline(always)]
            fn at_most(self, a: $values, b: $values) -> u8 {
                at_most(self, a, b)
            }

            #[inline(always)]
            fn select(self, bits: u8, a: $values, b: $values) -> $values {
                select(self, bits, a, b)
            }

            #[inline(always)]
            fn gather_from(self, pairs: &[Pair], at: &Places) -> [$values; 2] {
                // SAFETY: each address is that of a pair, two f64 in a row.
                unsafe { eight(self, at.of(pairs)) }
            }

            #[inline(always)]
            fn scatter_to(self, lanes: [$values; 2], pairs: &mut [Pair], at: &Places) {
                let (at, parts) = (at.of_mut(pairs), apart(self, lanes));
                for k in (0..LANES).rev() {
                    // SAFETY: the token proves the instructions; the address is that of a pair, two f64 in a row.
                    unsafe { _mm_storeu_pd(at[k], parts[k]) }
                }
            }
        }
    };
    ($trait:ident, $method:ident, $instruction:ident, $values:ident, $($k:literal)*) => {
        impl $trait for $values {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: registers at hand prove the instructions.
                Self(unsafe { [$($instruction(self.0[$k], other.0[$k])),*] })
            }
        }
    };
    // Methods of lanes that read and write pairs of a table one by one.
    ($values:ident by slots) => {
        #[inline(always)]
        fn gather(self, table: &Table, slots: &[Slot; LANES]) -> [$values; 2] {
            // SAFETY: each address is that of a pair, two f64 in a row.
            unsafe { eight(self, table.addresses(slots)) }
        }

        #[inline(always)]
        fn scatter_add(self, table: &mut Table, slots: &[Slot; LANES], lanes: [$values; 2]) {
            let parts = apart(self, lanes);
            for k in 0..LANES {
                let at = table.values_mut(slots[k]);
                // SAFETY: the token proves the instructions; the address is that of a pair, two f64 in a row.
                unsafe { _mm_storeu_pd(at, _mm_add_pd(_mm_loadu_pd(at), parts[k])) }
            }
        }
    };
}
