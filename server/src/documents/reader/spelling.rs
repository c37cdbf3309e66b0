//! What a misspelt name was probably meant to be.

/// A hint that lists the known names, the likely one first.
pub(super) fn hint(written: &str, known: &[&str]) -> String {
    let list = known.join(", ");
    match likely(written, known) {
        Some(name) => format!("did you mean {name:?}? Known here: {list}"),
        None => format!("known here: {list}"),
    }
}

fn likely<'a>(written: &str, known: &[&'a str]) -> Option<&'a str> {
    // A unit that was forgotten is the usual mistake: `max_torque` for `max_torque_nm`.
    let without_unit = known
        .iter()
        .find(|name| written.len() >= 3 && name.starts_with(written));
    // Comparing takes the product of the lengths; no misspelling is that long.
    if written.len() > 64 {
        return None;
    }
    let nearest = || {
        known
            .iter()
            .map(|name| (edit_distance(written, name), name))
            .filter(|(distance, name)| *distance <= name.len().max(6) / 3)
            .min()
            .map(|(_, name)| name)
    };
    without_unit.or_else(nearest).copied()
}

/// Number of characters to insert, delete or replace.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_single_edits() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
        assert_eq!(edit_distance("axis", "axis"), 0);
    }

    #[test]
    fn a_forgotten_unit_and_a_slip_are_recognised_but_nothing_far() {
        let known = ["axis", "inertia_kg_m2", "max_torque_nm"];
        assert_eq!(likely("inertia", &known), Some("inertia_kg_m2"));
        assert_eq!(likely("axes", &known), Some("axis"));
        assert_eq!(likely("friction", &known), None);
    }
}
