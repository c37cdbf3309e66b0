//! The description of the interface agrees with the code, and its examples are valid.

use crate::client::Request;
use crate::running::Service;
use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;

fn committed() -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "openapi.yaml"]
        .iter()
        .collect();
    std::fs::read_to_string(path).expect("openapi.yaml is there")
}

#[test]
fn the_committed_description_agrees_with_the_code() {
    let printed = Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .arg("openapi")
        .output();
    let printed = String::from_utf8(printed.expect("the binary starts").stdout).expect("UTF-8");
    let hint = "run: slewplan openapi > openapi.yaml";
    assert!(
        printed == committed(),
        "openapi.yaml is not that of the code; {hint}"
    );
    let service = Service::start();
    assert_eq!(service.get("/openapi.yaml").expect(200).body, printed);
}

#[test]
fn every_example_of_a_body_is_answered_with_success() {
    let service = Service::start();
    let description: Value = yaml_serde::from_str(&committed()).expect("YAML");
    let mut posted = 0;
    let paths = description["paths"].as_object().expect("paths");
    for (path, operations) in paths {
        for (method, operation) in operations.as_object().expect("operations") {
            let content = &operation["requestBody"]["content"]["application/json"];
            let named = content["examples"].as_object().into_iter().flatten();
            let examples = named
                .map(|(_, example)| &example["value"])
                .chain(content.get("example"));
            for example in examples {
                let path = path.replace("{name}", "example");
                let request = Request::new(&method.to_uppercase(), &path).json(example);
                let answer = service.send(&request);
                assert!(
                    (200..300).contains(&answer.status),
                    "{method} {path}: {answer:?}"
                );
                posted += 1;
            }
        }
    }
    assert!(posted >= 6, "{posted} examples");
}
