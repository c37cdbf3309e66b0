//! A small document of its own: what is read of it, what is said about it, how it is described.

use super::*;
use std::cell::RefCell;

input_object! {
    /// A tank
    /// of propellant.
    #[derive(Default)]
    struct TankSpec as "Tank" {
        /// What the tank is called.
        name: String = MemberRule::required_or_pointer().min_length(1),
        /// Where it is.
        place_m: [f64; 3] = required(),
        /// Propellant at the start.
        fill_kg: f64 = or(5.0).at_least(0.0),
        /// Pressure limit; 10 without it, none with `null`.
        max_pressure_pa: Option<f64> = nullable(10.0).above(0.0),
        /// What it is made of.
        material: Option<MaterialSpec> = optional(),
        /// Ways out.
        valves: Vec<ValveSpec> as UpTo<2, ValveSpec> = required_or(Vec::new()),
        /// Share that sloshes; part of another document where it is missing.
        sloshing: f64 = required_elsewhere(0.5),
    }
}

input_choice! {
    /// What a tank is made of.
    enum MaterialSpec as "Material" {
        /// Light.
        Titanium = "titanium",
        /// Cheap.
        Steel = "steel",
    }
}

input_union! {
    /// A way out of a tank.
    enum ValveSpec as "Valve" {
        /// Never shut.
        Hole = "hole",
        /// Shut by a spring.
        Check = "check" {
            /// Pressure at which it opens.
            opens_pa: f64 = required(),
            /// Whether it is welded.
            welded: bool = or(false),
        },
    }
}

input_object! {
    /// What a tank is filled from.
    #[derive(Default)]
    struct SourceSpec as "Source" {
        /// Number of the store.
        store: f64 = required_or(0.0).unless("truck"),
        /// Instead of it the truck.
        truck: Option<String> = optional(),
    }
}

input_object! {
    /// Anything with a name.
    struct LabelledSpec as "Labelled" open {
        /// The name.
        name: String = required(),
    }
}

/// A value of a document.
enum Written {
    Null,
    Number(f64),
    Text(&'static str),
    List(Vec<Written>),
    Object(Vec<(&'static str, Written)>),
}

use Written::{List, Null, Number, Object, Text};

/// Where a value stands, and what was found wrong on the way.
struct Reader<'a> {
    value: &'a Written,
    pointer: String,
    found: &'a RefCell<Vec<(String, Code)>>,
}

impl<'a> Reader<'a> {
    fn at(&self, name: &str, value: &'a Written) -> Self {
        Self {
            value,
            pointer: format!("{}/{name}", self.pointer),
            found: self.found,
        }
    }

    fn refuse<T>(&self) -> Option<T> {
        self.report(Code::WrongType, "", "");
        None
    }
}

impl InputPlace for Reader<'_> {
    fn pointer(&self) -> &str {
        &self.pointer
    }

    fn report(&self, code: Code, _: impl Into<String>, _: impl Into<String>) {
        self.found.borrow_mut().push((self.pointer.clone(), code));
    }

    fn is_null(&self) -> bool {
        matches!(self.value, Null)
    }

    fn is_number(&self) -> bool {
        matches!(self.value, Number(_))
    }

    fn is_text(&self) -> bool {
        matches!(self.value, Text(_))
    }

    fn is_list(&self) -> bool {
        matches!(self.value, List(_))
    }

    fn number(&self) -> Option<f64> {
        match self.value {
            Number(value) => Some(*value),
            _ => self.refuse(),
        }
    }

    fn integer(&self) -> Option<u64> {
        self.refuse()
    }

    fn boolean(&self) -> Option<bool> {
        self.refuse()
    }

    fn text(&self) -> Option<&str> {
        match self.value {
            Text(text) => Some(text),
            _ => self.refuse(),
        }
    }

    fn choice(&self, texts: &[&str]) -> Option<usize> {
        let text = self.text()?;
        let found = texts.iter().position(|known| *known == text);
        if found.is_none() {
            self.report(Code::UnknownChoice, "", "");
        }
        found
    }

    fn is_object(&self, known: Option<&[&str]>) -> bool {
        let Object(members) = self.value else {
            return self.refuse().unwrap_or(false);
        };
        for (name, value) in members {
            if known.is_some_and(|known| !known.contains(name)) {
                self.at(name, value).report(Code::UnknownField, "", "");
            }
        }
        true
    }

    fn member(&self, name: &str) -> Option<Self> {
        let Object(members) = self.value else {
            return None;
        };
        let (name, value) = members.iter().find(|(known, _)| *known == name)?;
        Some(self.at(name, value))
    }

    fn required(&self, name: &str) -> Option<Self> {
        let found = self.member(name);
        if found.is_none() {
            self.at(name, &Null).report(Code::MissingField, "", "");
        }
        found
    }

    fn required_unless(&self, name: &str, _: &str) -> Option<Self> {
        self.required(name)
    }

    fn entries(&self) -> Option<usize> {
        match self.value {
            List(entries) => Some(entries.len()),
            _ => self.refuse(),
        }
    }

    fn entry(&self, index: usize) -> Option<Self> {
        match self.value {
            List(entries) => Some(self.at(&index.to_string(), entries.get(index)?)),
            _ => None,
        }
    }
}

/// What is read of a value, and what is wrong with it.
fn read<F: InputForm>(value: &Written) -> (Option<F::Value>, Vec<(String, Code)>) {
    let found = RefCell::default();
    let pointer = String::new();
    let read = F::read(&Reader {
        value,
        pointer,
        found: &found,
    });
    (read, found.into_inner())
}

fn origin() -> Written {
    List(vec![Number(0.0), Number(0.0), Number(0.0)])
}

fn tank(members: Vec<(&'static str, Written)>) -> Written {
    let least = [
        ("name", Text("t")),
        ("place_m", origin()),
        ("valves", List(Vec::new())),
    ];
    let left_out = |name: &str| members.iter().all(|(given, _)| *given != name);
    let mut all: Vec<_> = least
        .into_iter()
        .filter(|(name, _)| left_out(name))
        .collect();
    all.extend(members);
    Object(all)
}

#[test]
fn what_is_left_out_has_its_default() {
    let (spec, problems) = read::<TankSpec>(&tank(Vec::new()));
    assert_eq!(problems, []);
    let expected = TankSpec {
        name: "t".into(),
        fill_kg: 5.0,
        max_pressure_pa: Some(10.0),
        sloshing: 0.5,
        ..TankSpec::default()
    };
    assert_eq!(spec, Some(expected));
}

#[test]
fn null_is_nothing_except_where_it_lifts_a_limit() {
    let (spec, problems) = read::<TankSpec>(&tank(vec![
        ("fill_kg", Null),
        ("max_pressure_pa", Null),
        ("material", Null),
    ]));
    assert_eq!(problems, []);
    let spec = spec.unwrap();
    assert_eq!((spec.fill_kg, spec.max_pressure_pa), (5.0, None));
    assert_eq!(spec.material, None);
}

#[test]
fn every_problem_is_found_in_the_order_of_the_declaration() {
    let valves = vec![
        Object(vec![("kind", Text("check")), ("welded", Null)]),
        Object(vec![("kind", Text("hole")), ("opens_pa", Number(1.0))]),
    ];
    let (spec, problems) = read::<TankSpec>(&Object(vec![
        ("sloshing", Text("1")),
        ("valves", List(valves)),
        ("material", Text("stel")),
        ("colour", Text("red")),
        ("place_m", List(vec![Number(0.0), Null])),
    ]));
    assert_eq!(spec, None);
    let expected = [
        ("/colour", Code::UnknownField),
        ("/name", Code::MissingField),
        ("/place_m", Code::WrongLength),
        ("/material", Code::UnknownChoice),
        ("/valves/0/opens_pa", Code::MissingField),
        ("/valves/1/opens_pa", Code::UnknownField),
        ("/sloshing", Code::WrongType),
    ];
    let expected = expected.map(|(pointer, code)| (pointer.to_owned(), code));
    assert_eq!(problems, expected);
}

#[test]
fn substitutes_stand_in_for_what_cannot_be_read() {
    let too_many = (0..3).map(|_| Null).collect();
    let unreadable = vec![("name", Null), ("valves", List(too_many))];
    let (spec, problems) = read::<TankSpec>(&tank(unreadable));
    let spec = spec.unwrap();
    // The pointer of the tank, which is the whole document.
    assert_eq!((spec.name.as_str(), spec.valves.len()), ("", 0));
    let expected = [("/name", Code::WrongType), ("/valves", Code::WrongLength)];
    let expected = expected.map(|(pointer, code)| (pointer.to_owned(), code));
    assert_eq!(problems, expected);
}

#[test]
fn of_members_that_stand_for_each_other_exactly_one_is_given() {
    let problem = |code| vec![("/store".to_owned(), code)];
    let truck = || ("truck", Text("t"));
    let cases = [
        (vec![("store", Number(3.0))], 3.0, Vec::new()),
        (
            vec![("store", Number(3.0)), ("truck", Null)],
            3.0,
            Vec::new(),
        ),
        (vec![truck()], 0.0, Vec::new()),
        (vec![truck(), ("store", Null)], 0.0, Vec::new()),
        (
            vec![truck(), ("store", Number(3.0))],
            0.0,
            problem(Code::ConflictingFields),
        ),
        (Vec::new(), 0.0, problem(Code::MissingField)),
        (vec![("truck", Null)], 0.0, problem(Code::MissingField)),
    ];
    for (members, store, expected) in cases {
        let (spec, problems) = read::<SourceSpec>(&Object(members));
        assert_eq!(problems, expected);
        assert_eq!(spec.map(|spec| spec.store), Some(store));
    }
    let Schema::Named(source) = SourceSpec::schema() else {
        panic!("it has a name")
    };
    let Schema::Object(members) = (source.schema)() else {
        panic!("it is an object")
    };
    let told: Vec<_> = members.iter().map(|m| (m.required, m.unless)).collect();
    assert_eq!(told, [(false, Some("truck")), (false, None)]);
}

#[test]
fn kinds_have_their_own_members() {
    let opening = vec![("kind", Text("check")), ("opens_pa", Number(2.0))];
    let (check, _) = read::<ValveSpec>(&Object(opening));
    let expected = ValveSpec::Check {
        opens_pa: 2.0,
        welded: false,
    };
    assert_eq!(check, Some(expected));
    let (hole, _) = read::<ValveSpec>(&Object(vec![("kind", Text("hole"))]));
    assert_eq!(hole, Some(ValveSpec::Hole));
}

#[test]
fn an_open_object_has_further_members() {
    let members = vec![("name", Text("a")), ("age", Number(7.0))];
    let (spec, problems) = read::<LabelledSpec>(&Object(members));
    assert_eq!(problems, []);
    assert_eq!(spec.unwrap().name, "a");
}

#[test]
fn the_first_text_of_a_choice_is_its_default() {
    assert_eq!(MaterialSpec::default(), MaterialSpec::Titanium);
    let texts = MaterialSpec::ALL
        .iter()
        .map(|&material| <&str>::from(material));
    assert_eq!(texts.collect::<Vec<_>>(), ["titanium", "steel"]);
}

#[test]
fn a_description_tells_what_is_declared() {
    let Schema::Named(tank) = TankSpec::schema() else {
        panic!("it has a name")
    };
    assert_eq!(tank.name, "Tank");
    assert_eq!(text_of(tank.doc), "A tank\nof propellant.");
    let Schema::Object(members) = (tank.schema)() else {
        panic!("it is an object")
    };
    let told = |member: &MemberSchema| (member.name, member.required, member.default);
    let expected = [
        ("name", true, None),
        ("place_m", true, None),
        ("fill_kg", false, Some(Literal::Number(5.0))),
        ("max_pressure_pa", false, None),
        ("material", false, None),
        ("valves", true, None),
        ("sloshing", true, None),
    ];
    assert_eq!(members.iter().map(told).collect::<Vec<_>>(), expected);
    assert_eq!(members[2].text, "Propellant at the start.");
    assert_eq!(members[2].bounds.minimum, Some(0.0));
    assert_eq!(members[3].bounds.exclusive_minimum, Some(0.0));
}
