//! Disjoint sets of ids.

use std::ops::IndexMut;

/// Disjoint sets of ids.
pub struct UnionFind<I>(Vec<I>);

impl<I: Copy + Ord> UnionFind<I>
where
    Vec<I>: IndexMut<I, Output = I>,
{
    /// Each id alone.
    pub fn new(ids: impl Iterator<Item = I>) -> Self {
        Self(ids.collect())
    }

    /// The least id of the set of an id.
    pub fn root(&mut self, mut k: I) -> I {
        while self.0[k] != k {
            let parent = self.0[k];
            self.0[k] = self.0[parent];
            k = self.0[k];
        }
        k
    }

    /// Makes one set of two.
    pub fn join(&mut self, a: I, b: I) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// The least id of the set of each id.
    pub fn roots(mut self) -> Vec<I> {
        let parents = self.0.clone();
        parents.into_iter().map(|k| self.root(k)).collect()
    }
}
