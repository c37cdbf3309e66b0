/* Failures of the disk, on request: writes and syncs of one database's files that go wrong.
 *
 * Loaded into the service with LD_PRELOAD. TRUST_SHIM names a file with the requests, which the
 * test maps too; TRUST_MATCH is a part of the names of the files that are concerned.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* What fails: the countdown-th call from now, and all after it while sticky. */
struct fault {
    int countdown;
    int error;
    int sticky;
    int calls;
};

struct requests {
    struct fault write;
    struct fault sync;
};

static struct requests *requests;
static const char *match;

__attribute__((constructor)) static void begin(void) {
    const char *path = getenv("TRUST_SHIM");
    match = getenv("TRUST_MATCH");
    int fd = path && match ? open(path, O_RDWR) : -1;
    if (fd < 0)
        return;
    void *map = mmap(NULL, sizeof *requests, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    requests = map == MAP_FAILED ? NULL : map;
    close(fd);
}

static int concerned(int fd) {
    char link[64], name[4096];
    if (!requests)
        return 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, name, sizeof name - 1);
    if (length < 0)
        return 0;
    name[length] = 0;
    return strstr(name, match) && !strstr(name, "-shm");
}

/* Whether this call fails; errno says how. */
static int fails(int fd, struct fault *fault) {
    if (!concerned(fd))
        return 0;
    __atomic_add_fetch(&fault->calls, 1, __ATOMIC_SEQ_CST);
    if (__atomic_load_n(&fault->countdown, __ATOMIC_SEQ_CST) <= 0)
        return 0;
    if (__atomic_sub_fetch(&fault->countdown, 1, __ATOMIC_SEQ_CST) > 0)
        return 0;
    if (fault->sticky)
        __atomic_store_n(&fault->countdown, 1, __ATOMIC_SEQ_CST);
    errno = fault->error;
    return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t pwrite(int fd, const void *data, size_t size, off_t offset) {
    return fails(fd, &requests->write) ? -1 : REAL(pwrite)(fd, data, size, offset);
}

ssize_t pwrite64(int fd, const void *data, size_t size, off64_t offset) {
    return fails(fd, &requests->write) ? -1 : REAL(pwrite64)(fd, data, size, offset);
}

ssize_t write(int fd, const void *data, size_t size) {
    return fails(fd, &requests->write) ? -1 : REAL(write)(fd, data, size);
}

int fsync(int fd) {
    return fails(fd, &requests->sync) ? -1 : REAL(fsync)(fd);
}

int fdatasync(int fd) {
    return fails(fd, &requests->sync) ? -1 : REAL(fdatasync)(fd);
}
