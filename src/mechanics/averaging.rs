//! Volume changes of rock that yields, averaged over physical covers, so that triangles do not lock where it flows
//! (Eqs. 58a–58c). A *patch* is the elements of one rock about one cover: averages stay on one side of joints, faces
//! and boundaries between rocks.

use enmm_lanes::LANES;
use rayon::prelude::*;

use crate::cover::{CoverId, Covers, ElementId};

use super::ElementRow;

/// Share of a whole star below which a cover is light: its neighbours' stress would push it out of the face. From 0.15
/// to 0.3 the factor of a slope in soil changes by 0.4 %.
const LIGHT_STAR: f64 = 0.2;

/// An element of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Member {
    element: ElementId,
    /// Its share in the mean of the patch: A/(3V).
    share: f64,
}

/// Which elements average their volume changes, and with what shares. Empty where no rock yields.
#[doc(alias = "mixed discretisation")]
#[doc(alias = "B-bar")]
#[doc(alias = "volumetric locking")]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Averaging {
    /// Whether each rock yields; empty when none does.
    yields: Vec<bool>,
    members: Vec<Member>,
    /// First member of each patch, and their number at the end.
    patch_start: Vec<u32>,
    /// The patches of each element; none where it keeps its own volume change.
    patches: Vec<Option<[PatchId; 3]>>,
    /// Elements eight by eight; none where they are not of one rock that yields.
    rows: Vec<Option<ElementRow>>,
}

crate::geometry::id! {
    /// A patch of elements that average their volume change.
    PatchId: optional
}

/// Elastic volume changes and mean stresses (Pa) in the plane, and how much of each the last step brought.
#[derive(Debug, Clone, Default)]
pub struct Averages {
    /// Volume change of each element.
    pub volume: Vec<[f64; 2]>,
    /// Mean stress of each element under the averaged volume change.
    pub mean: Vec<[f64; 2]>,
    /// Mean of the volume changes over each patch.
    pub patch_volume: Vec<[f64; 2]>,
    /// Mean of the mean stresses over each patch.
    pub patch_mean: Vec<[f64; 2]>,
}

/// Elements or patches that a thread takes together: fixed, so that sums over them do not depend on the threads.
pub const RUN: usize = 1024;

/// Fills a list run by run; `fill` gets the index of the first value of each.
pub fn fill_runs<T: Send>(serial: bool, list: &mut [T], fill: impl Fn(usize, &mut [T]) + Sync) {
    let fill = |(run, values): (usize, &mut [T])| fill(run * RUN, values);
    if serial {
        list.chunks_mut(RUN).enumerate().for_each(fill);
    } else {
        list.par_chunks_mut(RUN).enumerate().for_each(fill);
    }
}

/// Makes a list of what `value` gives for each of `count` indices.
fn list<T: Send + Default>(serial: bool, count: usize, list: &mut Vec<T>, value: impl Fn(usize) -> T + Sync) {
    list.resize_with(count, T::default);
    fill_runs(serial, list, |first, values| {
        values.iter_mut().enumerate().for_each(|(k, place)| *place = value(first + k));
    });
}

impl Averages {
    /// Averages volume changes over patches.
    pub fn average_volume(&mut self, averaging: &Averaging, serial: bool) {
        let Self { volume, patch_volume, .. } = self;
        list(serial, averaging.len(), patch_volume, |k| averaging.of_patch(k, |e| volume[e]));
    }

    /// Averages mean stresses over patches.
    pub fn average_mean(&mut self, averaging: &Averaging, serial: bool) {
        let Self { mean, patch_mean, .. } = self;
        list(serial, averaging.len(), patch_mean, |k| averaging.of_patch(k, |e| mean[e]));
    }
}

impl Averaging {
    /// The patches of all elements whose rock yields; elements with a light cover are in none.
    pub fn new(covers: &Covers, element_rock: &[u16], yields: Vec<bool>) -> Self {
        let can_yield = |e: ElementId| yields[element_rock[e] as usize];
        if !covers.elements().any(can_yield) {
            return Self::default();
        }
        let light = light_covers(covers);
        let averages = |e: &ElementId| can_yield(*e) && !covers.element_covers[*e].iter().any(|&cover| light[cover]);
        let corners = |e: ElementId| (0..3).map(move |corner| (e, corner));
        let mut places: Vec<(ElementId, usize)> = covers.elements().filter(averages).flat_map(corners).collect();
        let patch_of = |&(e, corner): &(ElementId, usize)| (covers.element_covers[e][corner], element_rock[e]);
        places.sort_by_key(|place| (patch_of(place), place.0));
        let mut averaging = Self { patches: vec![None; covers.element_count()], ..Self::default() };
        for patch in places.chunk_by(|a, b| patch_of(a) == patch_of(b)) {
            averaging.push(covers, patch);
        }
        averaging.patch_start.push(averaging.members.len() as u32);
        let row = |first: usize| {
            let elements = first..first + LANES;
            let rock = element_rock.get(elements.clone())?;
            let is_one = rock.iter().all(|other| *other == rock[0]) && can_yield(ElementId::new(first));
            is_one.then(|| ElementRow::new(covers, &averaging, elements))
        };
        averaging.rows = (0..covers.element_count()).step_by(LANES).map(row).collect();
        averaging.yields = yields;
        averaging
    }

    /// Whether elements of a rock can yield.
    pub fn yields(&self, rock: u16) -> bool {
        self.yields.get(rock as usize).is_some_and(|yields| *yields)
    }

    fn push(&mut self, covers: &Covers, places: &[(ElementId, usize)]) {
        let id = PatchId::new(self.patch_start.len());
        self.patch_start.push(self.members.len() as u32);
        let area: f64 = places.iter().map(|place| covers.element_area[place.0]).sum();
        for &(element, corner) in places {
            self.members.push(Member { element, share: covers.element_area[element] / area });
            self.patches[element].get_or_insert([id; 3])[corner] = id;
        }
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.patch_start.len().saturating_sub(1)
    }

    /// Whether no rock yields.
    pub fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }

    /// Memory (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.members)
            + size_of_val(&*self.patch_start)
            + size_of_val(&*self.patches)
            + size_of_val(&*self.rows)
    }

    /// The patches of an element; none where it keeps its own volume change.
    pub fn patches_of(&self, element: ElementId) -> Option<[PatchId; 3]> {
        self.patches[element]
    }

    /// The elements of the eight in a row from `first` on, if they are of one rock that yields.
    #[inline(always)]
    pub fn row(&self, first: usize) -> Option<&ElementRow> {
        self.rows[first / LANES].as_ref()
    }

    /// Mean over a patch of values that its elements have.
    #[inline]
    pub fn of_patch<const N: usize>(&self, patch: usize, value: impl Fn(ElementId) -> [f64; N]) -> [f64; N] {
        let members = self.patch_start[patch] as usize..self.patch_start[patch + 1] as usize;
        let mut mean = [0.0; N];
        for member in &self.members[members] {
            mean.iter_mut().zip(value(member.element)).for_each(|(mean, value)| *mean += member.share * value);
        }
        mean
    }

    /// Mean of what the three patches of an element have, from the values of the elements about it; none where it keeps
    /// its own value.
    pub fn around<const N: usize>(
        &self,
        element: ElementId,
        value: impl Fn(ElementId) -> [f64; N],
    ) -> Option<[f64; N]> {
        let patches = self.patches[element]?.map(|patch| self.of_patch(patch.index(), &value));
        Some(of_three(patches))
    }
}

fn of_three<const N: usize>([a, b, c]: [[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0)
}

/// Whether each cover has lost so much of its star to a cut that it is light.
fn light_covers(covers: &Covers) -> Vec<bool> {
    let whole = 3f64.sqrt() / 2.0 * covers.mesh.size.powi(2);
    let mut volume = vec![0.0; covers.cover_count()];
    for e in covers.elements() {
        covers.element_covers[e].iter().for_each(|&cover: &CoverId| volume[cover] += covers.element_area[e] / 3.0);
    }
    volume.iter().map(|volume| *volume < LIGHT_STAR * whole).collect()
}
