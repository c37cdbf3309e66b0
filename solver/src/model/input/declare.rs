//! The macros that declare what stands in a document.
//!
//! A declaration becomes the type as it would be written by hand and an implementation of
//! [`InputForm`](super::InputForm) for it. Members are read in the order of their declaration, all of them, so
//! that one pass finds everything that is wrong.

/// Declares an object: a struct whose fields are members with the same names.
///
/// A field is `name: Type = rule` or, where the type has a form other than itself,
/// `name: Type as Form = rule`. What [`rules`](crate::model::input::MemberRule) there are says
/// [`crate::model::input`]; its documentation shows an example. The literal after `as` is the name of
/// the object in descriptions; `open` behind it admits members that are not declared.
#[macro_export]
macro_rules! input_object {
    (@form $type:ty) => { $type };
    (@form $type:ty, $form:ty) => { $form };
    (@is_open) => { false };
    (@is_open open) => { true };
    (@object) => { $crate::model::input::Schema::Object };
    (@object open) => { $crate::model::input::Schema::OpenObject };
    (
        $(#[doc = $doc:literal])+
        $(#[derive($($derive:ident),+)])?
        $visibility:vis struct $name:ident as $schema:literal $($open:ident)? {
            $(
                $(#[doc = $field_doc:literal])+
                $field_visibility:vis $field:ident: $type:ty $(as $form:ty)? = $rule:expr
            ),+ $(,)?
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, PartialEq, $($($derive),+)?)]
        $visibility struct $name {
            $(
                $(#[doc = $field_doc])+
                $field_visibility $field: $type,
            )+
        }

        impl $crate::model::input::InputForm for $name {
            type Value = Self;

            fn read<P: $crate::model::input::InputPlace>(place: &P) -> Option<Self> {
                const NAMES: &[&str] = &[$(stringify!($field)),+];
                const IS_OPEN: bool = $crate::model::input::input_object!(@is_open $($open)?);
                let known = (!IS_OPEN).then_some(NAMES);
                let members = $crate::model::input::InputMembers::of(place, known);
                // All of them before the first that is missing ends it.
                $(
                    let $field = members.read::<$crate::model::input::input_object!(@form $type $(, $form)?)>(
                        stringify!($field),
                        $rule,
                    );
                )+
                Some(Self { $($field: $field?),+ })
            }

            fn schema() -> $crate::model::input::Schema {
                use $crate::model::input::{MemberSchema, NamedSchema, Schema};
                Schema::Named(NamedSchema {
                    name: $schema,
                    doc: concat!($($doc, "\n"),+),
                    schema: || $crate::model::input::input_object!(@object $($open)?)(vec![
                        $(
                            MemberSchema::of::<$crate::model::input::input_object!(@form $type $(, $form)?)>(
                                stringify!($field),
                                concat!($($field_doc, "\n"),+),
                                &$rule,
                            )
                        ),+
                    ]),
                })
            }
        }
    };
}

/// Declares one text of several: an enum whose variants are `Variant = "text"`.
///
/// The first variant is the default. `Display`, `FromStr` and `Into<&'static str>` have the texts of
/// documents.
#[macro_export]
macro_rules! input_choice {
    (
        $(#[doc = $doc:literal])+
        $visibility:vis enum $name:ident as $schema:literal {
            $(
                $(#[doc = $variant_doc:literal])+
                $variant:ident = $text:literal
            ),+ $(,)?
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::EnumString, strum::IntoStaticStr,
        )]
        $visibility enum $name {
            $(
                $(#[doc = $variant_doc])+
                #[strum(serialize = $text)]
                $variant,
            )+
        }

        impl $name {
            /// All of them.
            $visibility const ALL: &[Self] = &[$(Self::$variant),+];
        }

        impl Default for $name {
            fn default() -> Self {
                Self::ALL[0]
            }
        }

        impl $crate::model::input::InputForm for $name {
            type Value = Self;

            fn read<P: $crate::model::input::InputPlace>(place: &P) -> Option<Self> {
                Some(Self::ALL[place.choice(&[$($text),+])?])
            }

            fn schema() -> $crate::model::input::Schema {
                use $crate::model::input::{NamedSchema, Schema, text_of};
                Schema::Named(NamedSchema {
                    name: $schema,
                    doc: concat!($($doc, "\n"),+),
                    schema: || Schema::Choice(vec![
                        $(($text, text_of(concat!($($variant_doc, "\n"),+)))),+
                    ]),
                })
            }
        }
    };
}

/// Declares an object whose member `kind` says which further members it has: an enum whose variants
/// are `Variant = "kind"`, or `Variant = "kind" { .. }` with fields as those of
/// [`input_object!`](crate::input_object).
#[macro_export]
macro_rules! input_union {
    (
        $(#[doc = $doc:literal])+
        $(#[derive($($derive:ident),+)])?
        $visibility:vis enum $name:ident as $schema:literal {
            $(
                $(#[doc = $variant_doc:literal])+
                $variant:ident = $kind:literal $({
                    $(
                        $(#[doc = $field_doc:literal])+
                        $field:ident: $type:ty $(as $form:ty)? = $rule:expr
                    ),+ $(,)?
                })?
            ),+ $(,)?
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, PartialEq, $($($derive),+)?)]
        $visibility enum $name {
            $(
                $(#[doc = $variant_doc])+
                $variant $({
                    $(
                        $(#[doc = $field_doc])+
                        $field: $type,
                    )+
                })?,
            )+
        }

        impl $crate::model::input::InputForm for $name {
            type Value = Self;

            fn read<P: $crate::model::input::InputPlace>(place: &P) -> Option<Self> {
                const KINDS: &[&str] = &[$($kind),+];
                if !place.is_object(None) {
                    return None;
                }
                let kind = KINDS[place.required("kind")?.choice(KINDS)?];
                $(
                    if kind == $kind {
                        const NAMES: &[&str] = &["kind", $($(stringify!($field)),+)?];
                        let _members = $crate::model::input::InputMembers::of(place, Some(NAMES));
                        $($(
                            let $field =
                                _members.read::<$crate::model::input::input_object!(@form $type $(, $form)?)>(
                                    stringify!($field),
                                    $rule,
                                );
                        )+)?
                        return Some(Self::$variant $({ $($field: $field?),+ })?);
                    }
                )+
                None
            }

            fn schema() -> $crate::model::input::Schema {
                use $crate::model::input::{NamedSchema, Schema, text_of};
                Schema::Named(NamedSchema {
                    name: $schema,
                    doc: concat!($($doc, "\n"),+),
                    schema: || Schema::Kinds(vec![
                        $((
                            $kind,
                            text_of(concat!($($variant_doc, "\n"),+)),
                            vec![$($(
                                $crate::model::input::MemberSchema::of::<
                                    $crate::model::input::input_object!(@form $type $(, $form)?)
                                >(
                                    stringify!($field),
                                    concat!($($field_doc, "\n"),+),
                                    &$rule,
                                )
                            ),+)?],
                        )),+
                    ]),
                })
            }
        }
    };
}
