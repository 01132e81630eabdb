// The part of CUDA's driver interface that twinray calls, for one device whose memory is the host's: exported memory is
// mapped there. Structs are as in NVIDIA's documentation of the driver interface. Mesa's CPU driver begins exported
// memory with a header: its size, and where the exported part begins.
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

typedef struct {
    int type;
    union {
        int fd;
        struct {
            void* handle;
            const void* name;
        } win32;
        const void* nvSciBufObject;
    } handle;
    unsigned long long size;
    unsigned int flags;
    unsigned int reserved[16];
} HandleDesc;

typedef struct {
    unsigned long long offset;
    unsigned long long size;
    unsigned int flags;
    unsigned int reserved[16];
} BufferDesc;

typedef struct {
    int fd;
    unsigned long long size;
    void* mapped;
    size_t bytes;
} External;

static int depth = 0, imports = 0, waits = 0;

int fake_imports(void) { return imports; }
int fake_waits(void) { return waits; }
int fake_depth(void) { return depth; }

int cuInit(unsigned int flags) { return flags == 0 ? 0 : 1; }
int cuDeviceGetCount(int* count) { return *count = 1, 0; }
int cuDeviceGet(int* device, int ordinal) { return *device = ordinal + 7, ordinal == 0 ? 0 : 101; }
int cuDeviceGetUuid(unsigned char* uuid, int device) {
    const char* hex = getenv("FAKE_CUDA_UUID");
    for (int i = 0; hex && i < 16; ++i) {
        const char pair[3] = {hex[2 * i], hex[2 * i + 1], 0};
        uuid[i] = (unsigned char)strtoul(pair, 0, 16);
    }
    return device == 7 ? 0 : 101;
}
int cuDevicePrimaryCtxRetain(void** context, int device) { return *context = &depth, device == 7 ? 0 : 101; }
int cuDevicePrimaryCtxRelease_v2(int device) { return device == 7 ? 0 : 101; }
int cuDevicePrimaryCtxRelease(int device) { return device == 7 ? 0 : 101; }
int cuCtxPushCurrent_v2(void* context) { return ++depth, context == &depth ? 0 : 201; }
int cuCtxPopCurrent_v2(void** context) { return --depth, *context = &depth, 0; }
int cuCtxSynchronize(void) { return depth > 0 ? ++waits, 0 : 201; }
int cuImportExternalMemory(void** external, const HandleDesc* desc) {
    if (depth == 0) return 201;
    if (desc->type != 1 || desc->flags != 0) return 1;
    External* made = malloc(sizeof *made);
    *made = (External){desc->handle.fd, desc->size, 0, 0};
    return *external = made, ++imports, 0;
}
int cuExternalMemoryGetMappedBuffer(unsigned long long* pointer, External* external, const BufferDesc* desc) {
    if (depth == 0) return 201;
    if (desc->offset != 0 || desc->size > external->size || desc->flags != 0) return 1;
    const off_t end = lseek(external->fd, 0, SEEK_END);
    char* mapped = mmap(0, (size_t)end, PROT_READ | PROT_WRITE, MAP_SHARED, external->fd, 0);
    if (mapped == MAP_FAILED) return 2;
    external->mapped = mapped;
    external->bytes = (size_t)end;
    size_t begin;
    memcpy(&begin, mapped + sizeof(size_t), sizeof begin);
    return *pointer = (unsigned long long)(mapped + begin), begin + desc->size <= external->bytes ? 0 : 1;
}
int cuMemFree_v2(unsigned long long pointer) { return pointer ? 0 : 1; }
int cuDestroyExternalMemory(External* external) {
    if (depth == 0) return 201;
    munmap(external->mapped, external->bytes);
    close(external->fd);
    free(external);
    return --imports, 0;
}
