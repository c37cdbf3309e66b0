//! Tables as people write them, and what is said of those that cannot be read.

use super::*;

const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn read_with(text: &str, ignored: &[&str]) -> Result<TargetTable, Vec<Problem>> {
    let ignored: Vec<String> = ignored.iter().map(|name| (*name).to_owned()).collect();
    let reading = TableReading {
        boresight: Z,
        ignored: &ignored,
    };
    read(text.as_bytes(), &reading)
}

fn json(text: &str) -> String {
    let table = read_with(text, &[]).unwrap();
    assert_eq!(table.problems(), []);
    table.list().to_json()
}

/// Places and codes of everything that is wrong.
fn refused(text: &str) -> Vec<(String, Code)> {
    let problems = read_with(text, &[]).map_or_else(|problems| problems, |table| table.problems());
    assert!(problems.iter().all(|p| !p.hint.is_empty()), "{problems:?}");
    problems.into_iter().map(|p| (p.pointer, p.code)).collect()
}

fn expect_refused(text: &str, expected: &[(&str, Code)]) {
    let expected: Vec<_> = expected
        .iter()
        .map(|(place, code)| ((*place).to_owned(), *code))
        .collect();
    assert_eq!(refused(text), expected);
}

#[test]
fn every_form_of_attitudes_becomes_that_of_the_scenario() {
    assert_eq!(
        json("id,ra,dec,roll,dwell\nm31,10.68,41.27,5,60\n"),
        r#"[{"id":"m31","attitude":{"ra_dec_roll_deg":[10.68,41.27,5.0],"boresight":[0.0,0.0,1.0]},"dwell_s":60.0}]"#
    );
    assert_eq!(
        json("id,roll,pitch,yaw\na,1,2,3\n"),
        r#"[{"id":"a","attitude":{"roll_pitch_yaw_deg":[1.0,2.0,3.0]}}]"#
    );
    assert_eq!(
        json("id,qx,qy,qz,qw\na,0,0,0.6,0.8\n"),
        r#"[{"id":"a","attitude":{"quaternion":{"x":0.0,"y":0.0,"z":0.6,"w":0.8}}}]"#
    );
}

#[test]
fn names_of_columns_may_have_units_capitals_and_any_order() {
    let plain = json("id,ra,dec,roll,dwell,settle\na,1,2,3,4,5\n");
    let other =
        "\u{feff}Dwell [s]; SETTLE_S ;Right Ascension (deg);Dec;roll-deg;Name\r\n4; 5;1;2;3;a\r\n";
    assert_eq!(json(other), plain);
    assert_eq!(
        json("settle\tdwell\tID\troll\tra\tdec\n5\t4\ta\t3\t1\t2\n"),
        plain
    );
}

#[test]
fn what_may_be_left_out_is() {
    let plain = json("id,ra,dec\na,1,2\n");
    assert_eq!(json("id,ra,dec,dwell\n\n,,,\na,1,2,\n\n"), plain);
    assert_eq!(json("id,ra,dec,roll,roll_min,roll_max\na,1,2,,,\n"), plain);
    expect_refused("id,ra,dec\n\n,,\n", &[("line 1", Code::MissingField)]);
}

#[test]
fn without_a_roll_it_is_left_to_the_plan() {
    assert_eq!(
        json("id,ra,dec\nm31,10.68,41.27\n"),
        r#"[{"id":"m31","pointing":{"boresight":[0.0,0.0,1.0],"ra_dec_deg":[10.68,41.27]}}]"#
    );
    // Limits and rolls by lines.
    assert_eq!(
        json("id,ra,dec,roll_min [deg],Roll Max,roll\na,1,2,-5,6,\nb,3,4,,,7\n"),
        r#"[{"id":"a","pointing":{"boresight":[0.0,0.0,1.0],"ra_dec_deg":[1.0,2.0],"roll_min_deg":-5.0,"roll_max_deg":6.0}},{"id":"b","attitude":{"ra_dec_roll_deg":[3.0,4.0,7.0],"boresight":[0.0,0.0,1.0]}}]"#
    );
}

#[test]
fn windows_and_values_have_columns() {
    assert_eq!(
        json("id,ra,dec,Window [s],value\na,1,2,0..60 90/120,3.5\nb,1,2,,\n"),
        r#"[{"id":"a","pointing":{"boresight":[0.0,0.0,1.0],"ra_dec_deg":[1.0,2.0]},"value":3.5,"windows":[{"from_s":0.0,"to_s":60.0},{"from_s":90.0,"to_s":120.0}]},{"id":"b","pointing":{"boresight":[0.0,0.0,1.0],"ra_dec_deg":[1.0,2.0]}}]"#
    );
    // The epoch is that of the scenario.
    let dated = "id;ra;dec;windows\na;1;2;2026-01-01T00:00:00..2026-01-01T00:01:00\n";
    assert!(json(dated).contains(r#""from":"2026-01-01T00:00:00""#));
    expect_refused(
        "id,ra,dec,windows,value\na,1,2,noon,high\n",
        &[
            ("line 2, column 5 (value)", Code::WrongType),
            ("line 2, column 4 (windows)", Code::WrongType),
        ],
    );
}

#[test]
fn limits_of_the_roll_are_refused_where_they_stand() {
    expect_refused(
        "id,ra,dec,roll_min,roll_max\na,1,91,0,9\nb,1,2,9,0\nc,1,2,9,\nd,1,2,,0\ne,1,2,x,0\n",
        &[("line 6, column 4 (roll_min)", Code::WrongType)],
    );
    expect_refused(
        "id,ra,dec,roll_min,roll_max\na,1,91,0,9\nb,1,2,9,0\nc,1,2,9,\nd,1,2,,0\n",
        &[
            ("line 2, column 3 (dec)", Code::OutOfRange),
            ("line 3, column 4 (roll_min)", Code::EmptyRange),
            ("line 4, column 5 (roll_max)", Code::MissingField),
            ("line 5, column 4 (roll_min)", Code::MissingField),
        ],
    );
    let both = [("line 2, column 5 (roll_min)", Code::ConflictingFields)];
    expect_refused("id,ra,dec,roll,roll_min\na,1,2,3,4\n", &both);
    expect_refused("id,roll,pitch,yaw,roll_min\na,1,2,3,4\n", &both);
}

#[test]
fn all_problems_of_all_lines_are_found_at_once() {
    expect_refused(
        "id,ra,dec,dwell\na,north,2,1\n\n,1,,2\nc,1\n\"d\",1,\"2,5\",inf\n",
        &[
            ("line 2, column 2 (ra)", Code::WrongType),
            ("line 4, column 1 (id)", Code::MissingField),
            ("line 4, column 3 (dec)", Code::MissingField),
            ("line 5", Code::WrongLength),
            ("line 6, column 3 (dec)", Code::WrongType),
            ("line 6, column 4 (dwell)", Code::WrongType),
        ],
    );
}

#[test]
fn what_no_scenario_could_have_is_refused_where_it_stands() {
    expect_refused(
        "id,qx,qy,qz,qw,Dwell\na,0,0,0,1,-1\n\nb,0,0,0,2,0\na,0,0,0,1,0\n",
        &[
            ("line 2, column 6 (Dwell)", Code::OutOfRange),
            ("line 4", Code::QuaternionNorm),
            ("line 5, column 1 (id)", Code::DuplicateId),
        ],
    );
}

#[test]
fn a_head_that_says_too_little_or_too_much_is_refused() {
    expect_refused(
        "",
        &[
            ("line 1", Code::MissingField),
            ("line 1", Code::AttitudeForm),
        ],
    );
    expect_refused("id,roll\n", &[("line 1", Code::AttitudeForm)]);
    expect_refused("ra,dec\n1,2\n", &[("line 1", Code::MissingField)]);
    expect_refused("id,ra,dec,qx,qy,qz,qw\n", &[("line 1", Code::AttitudeForm)]);
    expect_refused(
        "id,ra,dec,dwel,RA_deg\nb,x,2,3,4\n",
        &[
            ("line 1, column 4 (dwel)", Code::UnknownField),
            ("line 1, column 5 (RA_deg)", Code::DuplicateField),
            ("line 2, column 2 (ra)", Code::WrongType),
        ],
    );
    let problems = read_with("id,ra,dec,dwel\n", &[]).unwrap_err();
    assert!(
        problems[0].hint.contains("did you mean \"dwell\"?"),
        "{problems:?}"
    );
}

#[test]
fn columns_are_left_out_on_request_only() {
    let text = "id,ra,dec,V mag\na,1,2,bright\n";
    expect_refused(text, &[("line 1, column 4 (V mag)", Code::UnknownField)]);
    let table = read_with(text, &["v_MAG"]).unwrap();
    assert_eq!(table.list().to_json(), json("id,ra,dec\na,1,2\n"));
}

#[test]
fn bytes_that_are_no_text_are_refused_by_line() {
    let reading = TableReading {
        boresight: Z,
        ignored: &[],
    };
    let problems = read(b"id,ra,dec\nM\xfcnchen,1,2\n", &reading).unwrap_err();
    assert_eq!(problems[0].pointer, "line 2");
}

#[test]
fn problems_of_other_places_stay_where_they_are() {
    let table = read_with("id,ra,dec\na,1,2\n", &[]).unwrap();
    for pointer in ["/start", "/targets", "/targets/1/id", "/targets/x"] {
        let problem = Problem::new(pointer, Code::OutOfRange, "what", "why");
        assert_eq!(table.located(problem.clone()), problem);
    }
    let problem = Problem::new(
        "/targets/0/attitude/ra_dec_roll_deg/1",
        Code::OutOfRange,
        "",
        "",
    );
    assert_eq!(table.located(problem).pointer, "line 2, column 3 (dec)");
}
