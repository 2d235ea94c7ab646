//! Structures that begin with their size, and may grow at their end.

/// A structure that begins with its size, and may grow at its end.
///
/// # Safety
/// The type must be `repr(C)`, without padding, and its first field `struct_size: usize`; `FIRST_SIZE` is its size in
/// version 1 of the interface.
pub unsafe trait Growing: Copy {
    /// Size in version 1 of the interface (bytes).
    const FIRST_SIZE: usize;
    /// Name in messages.
    const NAME: &str;
}

/// Size of a field (bytes).
pub const fn size_of_field<T, F>(_: fn(&T) -> &F) -> usize {
    size_of::<F>()
}

/// Takes each type with its size in version 1 and its fields.
macro_rules! sized {
    ($($type:ident $size:literal { $($field:ident)* })*) => { $(
        // SAFETY: `repr(C)`, and a size equal to the sum of its fields, as asserted below, leaves no room for padding.
        unsafe impl crate::growing::Growing for $type {
            const FIRST_SIZE: usize = $size;
            const NAME: &str = stringify!($type);
        }
        const _: () = {
            // Does not compile when a field is not listed.
            let _: fn(&$type) = |all| { let $type { $($field: _),* } = all; };
            assert!(size_of::<$type>() == 0 $(+ crate::growing::size_of_field(|all: &$type| &all.$field))*);
            assert!(size_of::<$type>() >= $size);
        };
    )* };
}
