//! Attitude ephemeris messages, read back by another project's parser.

use super::{closed_form, flight, labelled, options, scenario, stepped, written};
use crate::render::export::{ExportOptions, Format, write};
use ccsds_ndm::messages::aem::Aem;
use ccsds_ndm::traits::Ndm;

fn both(options: &ExportOptions) -> [Aem; 2] {
    [
        Aem::from_kvn(&written(Format::AemKvn, options)).unwrap(),
        Aem::from_xml(&written(Format::AemXml, options)).unwrap(),
    ]
}

#[test]
fn kvn_and_xml_have_the_same_content_with_rates_in_degrees() {
    for aem in both(&stepped(5.0)) {
        assert_eq!(aem.version, "2.0");
        assert_eq!(aem.body.segment.len(), 3);
        let first = &aem.body.segment[0];
        let peak = first.data.attitude_states[1]
            .quaternion_ang_vel
            .clone()
            .unwrap();
        let (angle, rate) = closed_form(5.0);
        assert_eq!(peak.epoch.to_string(), "2026-01-31T23:59:55.000000000");
        let q = &peak.quaternion;
        assert!((q.q3 - (0.5 * angle).sin()).abs() < 1e-14 && q.q1.abs() + q.q2.abs() < 1e-15);
        assert!((q.qc - (0.5 * angle).cos()).abs() < 1e-14);
        assert!((peak.ang_vel.angvel_z.value - rate.to_degrees()).abs() < 1e-13);
        let metadata = &first.metadata;
        assert_eq!(metadata.attitude_type.to_string(), "QUATERNION/ANGVEL");
        assert_eq!(metadata.ref_frame_a, "EME2000");
        assert_eq!(metadata.ref_frame_b, "SC_BODY_1");
        assert_eq!(metadata.angvel_frame.as_deref(), Some("SC_BODY_1"));
        assert_eq!(metadata.time_system, "UTC");
        assert_eq!(metadata.comment, ["Slew from start to a<1>"]);
        assert_eq!(metadata.object_name, "UNKNOWN");
        // The next segment begins where this one ends, in the next month.
        assert_eq!(
            metadata.stop_time.to_string(),
            "2026-02-01T00:00:00.000000000"
        );
        assert_eq!(aem.body.segment[1].metadata.start_time, metadata.stop_time);
    }
}

#[test]
fn a_message_may_leave_rates_out_and_name_its_object() {
    let chosen = ExportOptions {
        rates: false,
        object_name: Some("Sat & Co".into()),
        object_id: Some("2026-001A".into()),
        ..stepped(5.0)
    };
    for aem in both(&chosen) {
        let segment = &aem.body.segment[2];
        assert_eq!(segment.metadata.attitude_type.to_string(), "QUATERNION");
        assert_eq!(segment.metadata.angvel_frame, None);
        assert_eq!(segment.metadata.object_name, "Sat & Co");
        assert_eq!(segment.metadata.object_id, "2026-001A");
        let last = segment.data.attitude_states.last().unwrap();
        let last = last.quaternion_ephemeris.clone().unwrap();
        assert!((last.quaternion.q3 - (0.5 * closed_form(25.0).0).sin()).abs() < 1e-14);
    }
}

#[test]
fn the_header_has_creation_date_and_originator() {
    let text = written(Format::AemKvn, &stepped(5.0));
    let head: Vec<&str> = text.lines().take(5).collect();
    let expected = [
        "CCSDS_AEM_VERS = 2.0",
        "COMMENT Plan of the scenario ? & co",
        "CREATION_DATE = 2026-01-01T00:00:00.000000",
        "ORIGINATOR = SLEWPLAN",
        "",
    ];
    assert_eq!(head, expected);
    assert!(
        text.lines()
            .all(|line| line.len() <= 254 && line.is_ascii())
    );
    assert!(written(Format::AemXml, &options()).contains("Slew from a&lt;1&gt; to b"));
}

#[test]
fn a_missing_epoch_is_noted_in_a_comment() {
    assert!(!written(Format::AemKvn, &options()).contains("no epoch"));
    let text = write(Format::AemKvn, &scenario(""), &flight(), &options()).unwrap();
    assert!(
        text.contains("COMMENT The scenario has no epoch: times count from 2000-01-01T12:00:00")
    );
    assert!(text.contains("START_TIME = 2000-01-01T12:00:00.000000000"));
    assert_eq!(
        labelled().epoch().map(|epoch| epoch.to_string()),
        Some("2026-01-31T23:59:50".to_owned())
    );
}
