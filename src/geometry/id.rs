//! Ids: the number of a thing as a type of its own, so that a block is never taken for an edge. Each room makes the ids
//! of its own things by `id!`.
//!
//! Any id indexes any vector or slice; the name of a table says whose it is. An id holds its index plus one, so that
//! zero is free for `None`: an `Option` of an id has the size of the id.

/// Makes a type of ids that index vectors and slices; saved data hold the bare index.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(std::num::NonZeroU32);

        impl $name {
            /// The id of an index. Limits on the size of a model keep all indices below `u32::MAX`.
            #[inline(always)]
            pub const fn new(index: usize) -> Self {
                debug_assert!(index < u32::MAX as usize);
                Self(std::num::NonZeroU32::MIN.saturating_add(index as u32))
            }

            /// Its index.
            #[inline(always)]
            pub const fn index(self) -> usize {
                self.number() as usize
            }

            /// Its index as files and hosts have it.
            #[inline(always)]
            pub const fn number(self) -> u32 {
                self.0.get() - 1
            }

            /// The ids of some consecutive indices.
            pub fn range(indices: std::ops::Range<usize>) -> impl ExactSizeIterator<Item = Self> + Clone {
                indices.map(Self::new)
            }

            /// The ids of the first `count` indices.
            pub fn all(count: usize) -> impl ExactSizeIterator<Item = Self> + Clone {
                Self::range(0..count)
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::new(0)
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                write!(f, concat!(stringify!($name), "({})"), self.index())
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                self.index().fmt(f)
            }
        }

        impl<T> std::ops::Index<$name> for [T] {
            type Output = T;

            #[inline(always)]
            fn index(&self, id: $name) -> &T {
                &self[id.index()]
            }
        }

        impl<T> std::ops::IndexMut<$name> for [T] {
            #[inline(always)]
            fn index_mut(&mut self, id: $name) -> &mut T {
                &mut self[id.index()]
            }
        }

        impl<T> std::ops::Index<$name> for Vec<T> {
            type Output = T;

            #[inline(always)]
            fn index(&self, id: $name) -> &T {
                &self[id.index()]
            }
        }

        impl<T> std::ops::IndexMut<$name> for Vec<T> {
            #[inline(always)]
            fn index_mut(&mut self, id: $name) -> &mut T {
                &mut self[id.index()]
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_u32(self.number())
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let number = <u32 as serde::Deserialize>::deserialize(deserializer)?;
                number.checked_add(1).and_then(std::num::NonZeroU32::new).map(Self).ok_or_else(|| {
                    serde::de::Error::custom(concat!("no ", stringify!($name), " has the number 4294967295"))
                })
            }
        }
    };
}

pub(crate) use id;

#[cfg(test)]
mod tests {
    id! {
        /// Of a test.
        ThingId
    }

    #[test]
    fn an_option_has_the_size_of_the_id_and_saved_data_hold_the_index() {
        assert_eq!(size_of::<Option<ThingId>>(), size_of::<u32>());
        let ids: Vec<ThingId> = ThingId::all(300).collect();
        assert_eq!(ids[ThingId::new(299)].index(), 299);
        let numbers: Vec<u32> = (0..300).collect();
        let saved = postcard::to_stdvec(&ids).expect("ids");
        assert_eq!(saved, postcard::to_stdvec(&numbers).expect("numbers"));
        assert_eq!(postcard::from_bytes(&saved), Ok(ids));
        assert!(postcard::from_bytes::<ThingId>(&postcard::to_stdvec(&u32::MAX).expect("a number")).is_err());
    }
}
