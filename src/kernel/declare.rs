//! Structs that the host and a device both hold, declared once: the Rust struct, its members for the
//! WGSL one, and the way of their values there and back all follow from the same lines.

/// What a member is on a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// So many wide numbers: one, or an array.
    Wide(usize),
    /// A u32: a count, a flag or a status.
    Count,
    /// Members of its own, whose names follow its name after an underscore.
    Group(&'static [Member]),
}

/// A member of such a struct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member {
    /// Its name, the same on both sides.
    pub name: &'static str,
    /// What it is.
    pub kind: Kind,
}

/// Members of a struct with the names that they have in WGSL: a group's own are joined to its name, since a
/// uniform buffer has no small structs.
pub fn members(kind: Kind) -> Vec<(String, Kind)> {
    fn flatten(prefix: &str, kind: Kind, all: &mut Vec<(String, Kind)>) {
        match kind {
            Kind::Group(members) => members.iter().for_each(|member| {
                let name = match prefix {
                    "" => member.name.to_owned(),
                    _ => format!("{prefix}_{}", member.name),
                };
                flatten(&name, member.kind, all);
            }),
            _ => all.push((prefix.to_owned(), kind)),
        }
    }
    let mut all = Vec::new();
    flatten("", kind, &mut all);
    all
}

/// One value on its way to a device or back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Word {
    /// A wide number.
    Wide(f64),
    /// A u32.
    Count(u32),
}

/// A value that a device holds too.
pub trait DeviceValue {
    /// What it is there.
    const KIND: Kind;
    /// Hands over its words in the order of its members.
    fn give(&self, to: &mut dyn FnMut(Word));
}

/// A value that comes back from a device.
pub trait FromDevice: DeviceValue {
    /// Takes its words in the order of its members.
    fn take(from: &mut dyn FnMut(Kind) -> Word) -> Self;
}

impl DeviceValue for f64 {
    const KIND: Kind = Kind::Wide(1);
    fn give(&self, to: &mut dyn FnMut(Word)) {
        to(Word::Wide(*self));
    }
}

impl FromDevice for f64 {
    fn take(from: &mut dyn FnMut(Kind) -> Word) -> Self {
        match from(Kind::Wide(1)) {
            Word::Wide(value) => value,
            Word::Count(count) => f64::from(count),
        }
    }
}

impl<const N: usize> DeviceValue for [f64; N] {
    const KIND: Kind = Kind::Wide(N);
    fn give(&self, to: &mut dyn FnMut(Word)) {
        self.iter().for_each(|&value| to(Word::Wide(value)));
    }
}

impl<const N: usize> FromDevice for [f64; N] {
    fn take(from: &mut dyn FnMut(Kind) -> Word) -> Self {
        std::array::from_fn(|_| f64::take(from))
    }
}

impl DeviceValue for u32 {
    const KIND: Kind = Kind::Count;
    fn give(&self, to: &mut dyn FnMut(Word)) {
        to(Word::Count(*self));
    }
}

impl FromDevice for u32 {
    fn take(from: &mut dyn FnMut(Kind) -> Word) -> Self {
        match from(Kind::Count) {
            Word::Count(count) => count,
            Word::Wide(value) => value as u32,
        }
    }
}

impl DeviceValue for bool {
    const KIND: Kind = Kind::Count;
    fn give(&self, to: &mut dyn FnMut(Word)) {
        to(Word::Count(u32::from(*self)));
    }
}

impl FromDevice for bool {
    fn take(from: &mut dyn FnMut(Kind) -> Word) -> Self {
        u32::take(from) != 0
    }
}

/// Declares a struct that a device holds too; with `and back` it can be read back from there.
macro_rules! device_struct {
    ($(#[$doc:meta])* pub struct $name:ident and back { $($(#[$about:meta])* $member:ident: $kind:ty,)* }) => {
        $crate::kernel::declare::device_struct! {
            $(#[$doc])* #[derive(Default)] pub struct $name { $($(#[$about])* $member: $kind,)* }
        }
        impl $crate::kernel::declare::FromDevice for $name {
            fn take(
                from: &mut dyn FnMut($crate::kernel::declare::Kind) -> $crate::kernel::declare::Word,
            ) -> Self {
                $name { $($member: $crate::kernel::declare::FromDevice::take(from),)* }
            }
        }
    };
    ($(#[$doc:meta])* pub struct $name:ident { $($(#[$about:meta])* $member:ident: $kind:ty,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            $($(#[$about])* pub $member: $kind,)*
        }
        impl $crate::kernel::declare::DeviceValue for $name {
            const KIND: $crate::kernel::declare::Kind = $crate::kernel::declare::Kind::Group(&[
                $($crate::kernel::declare::Member {
                    name: stringify!($member),
                    kind: <$kind as $crate::kernel::declare::DeviceValue>::KIND,
                },)*
            ]);
            fn give(&self, to: &mut dyn FnMut($crate::kernel::declare::Word)) {
                $($crate::kernel::declare::DeviceValue::give(&self.$member, to);)*
            }
        }
    };
}
pub(crate) use device_struct;
