//! Hints for unknown names: the known names, the most similar one first.

/// A hint that lists the known names, the likely one first.
pub(crate) fn hint(written: &str, known: &[&str]) -> String {
    let list = known.join(", ");
    match likely(written, known) {
        Some(name) => format!("did you mean {name:?}? Known here: {list}"),
        None => format!("known here: {list}"),
    }
}

fn likely<'a>(written: &str, known: &[&'a str]) -> Option<&'a str> {
    // The usual mistake is a missing unit: `max_torque` for `max_torque_nm`.
    let without_unit = known
        .iter()
        .find(|name| written.len() >= 3 && name.starts_with(written));
    // The distance takes time proportional to the product of the lengths; the cap bounds it.
    if written.len() > 64 {
        return None;
    }
    let nearest = || {
        known
            .iter()
            .map(|name| (strsim::levenshtein(written, name), name))
            .filter(|(distance, name)| *distance <= name.len().max(6) / 3)
            .min()
            .map(|(_, name)| name)
    };
    without_unit.or_else(nearest).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_units_and_small_misspellings_are_recognised() {
        let known = ["axis", "inertia_kg_m2", "max_torque_nm"];
        assert_eq!(likely("inertia", &known), Some("inertia_kg_m2"));
        assert_eq!(likely("axes", &known), Some("axis"));
        assert_eq!(likely("friction", &known), None);
    }
}
