#!/bin/sh
# A Postgres of its own for tests: prints the folder of its socket once it accepts connections, and
# ends and disappears with its standard input, so that no test leaves one behind, however it ends.
# Further arguments are those of `postgres`, whose log is server.log in the folder.
# Of its input it reads the lines `kill`, for an end without a shutdown, and `start`; each is answered.
set -eu

# It refuses to run as root. The other user may not be able to read this file: it is given the text.
if [ "$(id -u)" -eq 0 ]; then
    user=postgres
    id "$user" >/dev/null 2>&1 || user=nobody
    exec setpriv --reuid="$user" --regid="$(id -g "$user")" --clear-groups \
        sh -c "$(cat "$0")" "$0" "$@"
fi

# Debian keeps the programs of a server out of PATH.
for folder in /usr/lib/postgresql/*/bin; do
    if [ -x "$folder/initdb" ]; then
        PATH="$folder:$PATH"
    fi
done
command -v initdb >/dev/null || { echo "Postgres is not installed" >&2; exit 3; }

cd /
folder=$(mktemp -d "${TMPDIR:-/tmp}/slewplan-postgres-XXXXXX")
server=
end() {
    if [ -n "$server" ]; then
        kill -QUIT "$server" 2>/dev/null || true
        wait "$server" 2>/dev/null || true
    fi
    rm -rf "$folder"
}
trap end EXIT
trap 'exit 1' HUP INT TERM

initdb --pgdata="$folder/data" --auth=trust --username=slewplan --encoding=UTF8 \
    --locale=C.UTF-8 --no-sync >"$folder/initdb.log" 2>&1 \
    || { cat "$folder/initdb.log" >&2; exit 1; }
# With POSTGRES_TLS, only by TCP with TLS, at the port PGPORT: ca.crt has signed the certificate.
if [ -n "${POSTGRES_TLS-}" ]; then
    command -v openssl >/dev/null || { echo "openssl is not installed" >&2; exit 3; }
    cd "$folder/data"
    {
        openssl req -new -x509 -days 2 -nodes -subj /CN=test -keyout ca.key -out "$folder/ca.crt"
        openssl req -new -nodes -subj /CN=localhost -keyout server.key -out server.csr
        echo subjectAltName=DNS:localhost >names
        openssl x509 -req -days 2 -in server.csr -CA "$folder/ca.crt" -CAkey ca.key -CAcreateserial \
            -extfile names -out server.crt
    } 2>"$folder/openssl.log" || { cat "$folder/openssl.log" >&2; exit 1; }
    chmod 600 server.key
    sed -i 's/^host /hostssl /' pg_hba.conf
    set -- -c ssl=on -c listen_addresses=localhost "$@"
    cd /
fi
# Writes are synced, as where it serves. The socket alone: no port can be taken already.
start() {
    postgres -D "$folder/data" -k "$folder" -c listen_addresses= -c max_connections=200 \
        -c logging_collector=off "$@" >>"$folder/server.log" 2>&1 </dev/null &
    server=$!
    until pg_isready --quiet --host="$folder"; do
        kill -0 "$server" 2>/dev/null || { cat "$folder/server.log" >&2; exit 1; }
        sleep 0.05
    done
    echo "$folder"
}
start "$@"
while read -r command; do
    case "$command" in
        kill) kill -QUIT "$server" 2>/dev/null || true; wait "$server" || true; echo killed ;;
        start) start "$@" ;;
        *) exit 2 ;;
    esac
done
