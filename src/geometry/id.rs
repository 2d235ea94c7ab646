//! Ids: the number of a thing as a type of its own, so that a block is never taken for an edge. Each room makes the ids
//! of its own things by `id!`.
//!
//! Any id indexes any vector or slice; the name of a table says whose it is. Saved data hold the bare index.

/// Ids by which the loops of a step look things up: they hold the index, so that a look-up costs no more than by a
/// number (by the other kind a step of contacts has 2 % more instructions).
pub(crate) mod plain {
    pub type Held = u32;

    #[inline(always)]
    pub const fn hold(number: u32) -> Held {
        number
    }

    #[inline(always)]
    pub const fn number(held: Held) -> u32 {
        held
    }
}

/// Ids of which tables hold an `Option`: they hold the index plus one, so that zero is free for `None`, and an `Option`
/// has the size of the id.
pub(crate) mod optional {
    pub type Held = std::num::NonZeroU32;

    #[inline(always)]
    pub const fn hold(number: u32) -> Held {
        Held::MIN.saturating_add(number)
    }

    #[inline(always)]
    pub const fn number(held: Held) -> u32 {
        held.get() - 1
    }
}

/// Makes a type of ids, `plain` or `optional`, that index vectors and slices.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident: $kind:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(crate::geometry::id::$kind::Held);

        impl $name {
            /// The id of an index. Limits on the size of a model keep all indices below `u32::MAX`.
            #[inline(always)]
            pub const fn new(index: usize) -> Self {
                debug_assert!(index < u32::MAX as usize);
                Self(crate::geometry::id::$kind::hold(index as u32))
            }

            /// Its index.
            #[inline(always)]
            pub const fn index(self) -> usize {
                self.number() as usize
            }

            /// Its index as files and hosts have it.
            #[inline(always)]
            pub const fn number(self) -> u32 {
                crate::geometry::id::$kind::number(self.0)
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
                if number == u32::MAX {
                    let none = concat!("no ", stringify!($name), " has the number 4294967295");
                    return Err(serde::de::Error::custom(none));
                }
                Ok(Self::new(number as usize))
            }
        }
    };
}

pub(crate) use id;

#[cfg(test)]
mod tests {
    id! {
        /// Of a test.
        PlainId: plain
    }
    id! {
        /// Of a test.
        OptionalId: optional
    }

    #[test]
    fn an_option_has_the_size_of_an_optional_id() {
        assert_eq!(size_of::<Option<OptionalId>>(), size_of::<PlainId>());
    }

    #[test]
    fn saved_data_hold_the_index() {
        let numbers: Vec<u32> = (0..300).collect();
        let saved = postcard::to_stdvec(&numbers).expect("numbers");
        let (plain, optional): (Vec<PlainId>, Vec<OptionalId>) = PlainId::all(300).zip(OptionalId::all(300)).unzip();
        assert_eq!((plain[PlainId::new(299)].index(), optional[OptionalId::new(299)].index()), (299, 299));
        assert_eq!(postcard::to_stdvec(&plain), Ok(saved.clone()));
        assert_eq!(postcard::to_stdvec(&optional), Ok(saved.clone()));
        assert_eq!(postcard::from_bytes(&saved), Ok(plain));
        assert_eq!(postcard::from_bytes(&saved), Ok(optional));
        let greatest = postcard::to_stdvec(&u32::MAX).expect("a number");
        assert!(postcard::from_bytes::<PlainId>(&greatest).is_err());
        assert!(postcard::from_bytes::<OptionalId>(&greatest).is_err());
    }
}
