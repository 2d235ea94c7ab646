//! Sorting things by small numbers: a count of each number, then one pass over the things.

/// Lists the first `count` indices by bucket, of which there are `buckets`, in their order within each; `first` becomes
/// the first place of every bucket, and the number of all.
#[inline(always)]
pub fn sort(
    count: usize,
    buckets: usize,
    bucket: impl Fn(usize) -> usize,
    first: &mut Vec<u32>,
    sorted: &mut Vec<u32>,
) {
    first.clear();
    first.resize(buckets + 1, 0);
    (0..count).for_each(|k| first[bucket(k)] += 1);
    let mut end = 0;
    for first in first.iter_mut() {
        end += *first;
        *first = end;
    }
    sorted.resize(count, 0);
    for k in (0..count).rev() {
        let slot = &mut first[bucket(k)];
        *slot -= 1;
        sorted[*slot as usize] = k as u32;
    }
}
