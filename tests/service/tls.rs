//! Postgres by TLS.

use crate::postgres::Server;
use crate::running::{Service, slewplan, small};
use std::net::TcpListener;

/// A free port of this machine.
fn free_port() -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    listener
        .local_addr()
        .expect("an address")
        .port()
        .to_string()
}

#[test]
fn connections_are_encrypted_and_servers_verified_as_the_address_says() {
    let port = free_port();
    let Some(server) = Server::start_with(&[("POSTGRES_TLS", "on"), ("PGPORT", &port)]) else {
        return println!("not run: Postgres or openssl is not installed");
    };
    let authority = format!("{}/ca.crt", server.socket);
    let address = |host: &str, mode: &str, authority: &str| {
        format!("postgres://slewplan@{host}:{port}/postgres?sslmode={mode}{authority}")
    };
    let authority = format!("&sslrootcert={authority}");
    for (host, mode, authority, goes) in [
        ("localhost", "verify-full", &*authority, true),
        ("localhost", "require", "", true),
        // It takes no other connections.
        ("localhost", "disable", "", false),
        // Nobody known has signed its certificate.
        ("localhost", "verify-full", "", false),
        // It has another name.
        ("127.0.0.1", "verify-full", &authority, false),
        ("127.0.0.1", "verify-ca", &authority, true),
    ] {
        let address = address(host, mode, authority);
        let told = slewplan(&["keys", "list", "--database", &address]);
        assert_eq!(told.status.success(), goes, "{address}: {told:?}");
    }
    let address = address("localhost", "verify-full", &authority);
    let service = Service::on_database(address.as_ref(), &[]);
    let id = service.submit(&small());
    assert_eq!(service.wait_end(&id)["state"], "succeeded");
}
