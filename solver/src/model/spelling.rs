//! Which known name was probably meant.

/// The known name that was probably meant, if any is near.
#[must_use]
pub fn likely<'a>(written: &str, known: &[&'a str]) -> Option<&'a str> {
    // The usual mistake is a missing unit: `max_torque` for `max_torque_nm`.
    let without_unit = known
        .iter()
        .find(|name| written.len() >= 3 && name.starts_with(written));
    // The distance takes time proportional to the product of the lengths; the cap bounds it.
    if written.len() > 64 {
        return None;
    }
    let in_other_case = || known.iter().find(|name| name.eq_ignore_ascii_case(written));
    let nearest = || {
        known
            .iter()
            .map(|name| (strsim::osa_distance(written, name), name))
            .filter(|(distance, name)| *distance <= name.len().max(6) / 3)
            .min()
            .map(|(_, name)| name)
    };
    let found = without_unit.or_else(in_other_case);
    found.or_else(nearest).copied()
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

    #[test]
    fn exchanged_letters_are_one_mistake_and_case_is_none() {
        let known = ["TAI", "UT1", "UTC"];
        assert_eq!(likely("UCT", &known), Some("UTC"));
        assert_eq!(likely("tai", &known), Some("TAI"));
    }
}
