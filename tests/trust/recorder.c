/* What a database asks of the disk, in order: its writes, truncations and syncs.
 *
 * Loaded into the service with LD_PRELOAD. RECORDER_DATABASE names the database, RECORDER_LOG the
 * file to which a record of every call is appended that has succeeded. One call at a time: the order
 * of the records is that of the calls.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

enum kind { WRITE = 1, TRUNCATE = 2, SYNC = 3 };

/* Before the data of a write. For a truncation the length is the new size. */
struct record {
    uint32_t kind;
    uint32_t is_log;
    uint64_t offset;
    uint64_t length;
};

static const char *database;
static int record_fd = -1;
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

__attribute__((constructor)) static void begin(void) {
    const char *path = getenv("RECORDER_LOG");
    database = getenv("RECORDER_DATABASE");
    if (path && database)
        record_fd = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
}

/* 0: the database, 1: its write-ahead log, -1: anything else. */
static int file_of(int fd) {
    char link[64], name[4096];
    if (record_fd < 0)
        return -1;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t size = readlink(link, name, sizeof name - 1);
    size_t known = strlen(database);
    if (size < (ssize_t)known || memcmp(name, database, known) != 0)
        return -1;
    name[size] = 0;
    if (name[known] == 0)
        return 0;
    return strcmp(name + known, "-wal") == 0 ? 1 : -1;
}

/* A record that cannot be written would be a hole in the evidence. */
static void put(enum kind kind, int file, uint64_t offset, const void *data, uint64_t length) {
    struct record record = {kind, (uint32_t)file, offset, length};
    size_t size = kind == WRITE ? length : 0;
    struct iovec parts[2] = {{&record, sizeof record}, {(void *)data, size}};
    if (writev(record_fd, parts, 2) != (ssize_t)(sizeof record + size))
        abort();
}

static ssize_t written(int file, off64_t offset, const void *data, ssize_t size) {
    if (size > 0)
        put(WRITE, file, (uint64_t)offset, data, (uint64_t)size);
    return size;
}

#define IN_TURN(type, call)              \
    do {                                 \
        pthread_mutex_lock(&turn);       \
        type result = call;              \
        int saved = errno;               \
        pthread_mutex_unlock(&turn);     \
        errno = saved;                   \
        return result;                   \
    } while (0)

ssize_t pwrite64(int fd, const void *data, size_t size, off64_t offset) {
    int file = file_of(fd);
    if (file < 0)
        return REAL(pwrite64)(fd, data, size, offset);
    IN_TURN(ssize_t, written(file, offset, data, REAL(pwrite64)(fd, data, size, offset)));
}

ssize_t pwrite(int fd, const void *data, size_t size, off_t offset) {
    return pwrite64(fd, data, size, offset);
}

ssize_t write(int fd, const void *data, size_t size) {
    int file = file_of(fd);
    if (file < 0)
        return REAL(write)(fd, data, size);
    off64_t offset = lseek64(fd, 0, SEEK_CUR);
    IN_TURN(ssize_t, written(file, offset, data, REAL(write)(fd, data, size)));
}

static int truncated(int fd, int file, off64_t size) {
    int result = REAL(ftruncate64)(fd, size);
    if (result == 0)
        put(TRUNCATE, file, 0, NULL, (uint64_t)size);
    return result;
}

int ftruncate64(int fd, off64_t size) {
    int file = file_of(fd);
    if (file < 0)
        return REAL(ftruncate64)(fd, size);
    IN_TURN(int, truncated(fd, file, size));
}

int ftruncate(int fd, off_t size) {
    return ftruncate64(fd, size);
}

static int synced(int file, int result) {
    if (result == 0)
        put(SYNC, file, 0, NULL, 0);
    return result;
}

int fsync(int fd) {
    int file = file_of(fd);
    if (file < 0)
        return REAL(fsync)(fd);
    IN_TURN(int, synced(file, REAL(fsync)(fd)));
}

int fdatasync(int fd) {
    int file = file_of(fd);
    if (file < 0)
        return REAL(fdatasync)(fd);
    IN_TURN(int, synced(file, REAL(fdatasync)(fd)));
}
