//! Rows of queries: one declaration gives the struct, the columns it selects and how it is read.

/// Declares a struct that is read from a row, every field from the column of its name. With
/// `columns name;` before it, the macro `name!()` is the list of these columns for a statement.
macro_rules! row {
    (
        columns $columns:ident;
        $(#[$about:meta])*
        $seen:vis struct $row:ident {
            $(#[$about_first:meta])*
            $seen_first:vis $first:ident: $type_first:ty,
            $($(#[$about_field:meta])* $seen_field:vis $field:ident: $type_field:ty,)*
        }
    ) => {
        macro_rules! $columns {
            () => {
                concat!(stringify!($first) $(, ", ", stringify!($field))*)
            };
        }

        row! {
            $(#[$about])*
            $seen struct $row {
                $(#[$about_first])*
                $seen_first $first: $type_first,
                $($(#[$about_field])* $seen_field $field: $type_field,)*
            }
        }
    };
    (
        $(#[$about:meta])*
        $seen:vis struct $row:ident {
            $($(#[$about_field:meta])* $seen_field:vis $field:ident: $type:ty,)*
        }
    ) => {
        $(#[$about])*
        $seen struct $row {
            $($(#[$about_field])* $seen_field $field: $type,)*
        }

        impl $crate::store::database::row::FromRow for $row {
            fn from_row(
                row: $crate::store::database::row::Row<'_>,
            ) -> Result<Self, $crate::store::StoreError> {
                Ok(Self {
                    $($field: row.get(stringify!($field))?,)*
                })
            }
        }
    };
}
