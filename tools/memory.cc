// How every tool takes memory from the system. The kernel maps a page when it is first touched, and the pages of 4 kB
// that it maps by default cost a quarter of fettle-compare's time over a million triangles, and half of fettle-clean's.
//
// Large blocks get huge pages of 2 MB, which on Debian the kernel gives only to programs that ask for them. The C
// library asks if its environment says so (GLIBC_TUNABLES=glibc.malloc.hugetlb=1), which a tool cannot set for itself.
// The linker leads the calls of malloc(), Eigen's among them, to __wrap_malloc() (--wrap=malloc).
//
// What is freed is kept for the next block. By default malloc() gives back what is free at the end of its heap from
// 128 kB on, and takes it again: a fit of 30 touches did so in every step, for a third of its time. It raises its
// limits when large blocks are freed; here they are from the start where it would raise them to.

#include <malloc.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
constexpr std::size_t kMinHugeBlock = 2 * kHugePage; // holds a whole huge page wherever it begins
constexpr int kMaxHeapBlock = 32 << 20;              // malloc()'s own maximum; larger ones are mapped one by one

[[gnu::constructor]] void set_limits()
{
    mallopt(M_MMAP_THRESHOLD, kMaxHeapBlock);
    mallopt(M_TRIM_THRESHOLD, 2 * kMaxHeapBlock); // twice the other limit, as malloc() itself has it
}

/// Asks for huge pages in what a block holds of them. Where the kernel has none, nothing changes.
void ask_for_huge_pages(void* block, std::size_t size)
{
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    const std::uintptr_t begin = (address + kHugePage - 1) / kHugePage * kHugePage;
    const std::uintptr_t end = (address + size) / kHugePage * kHugePage;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

} // namespace

extern "C" {

void* __real_malloc(std::size_t size);

void* __wrap_malloc(std::size_t size)
{
    void* const block = __real_malloc(size);
    if (size >= kMinHugeBlock && block) ask_for_huge_pages(block, size);
    return block;
}

} // extern "C"

// The standard library's would call malloc() past the wrapper. Those of arrays call these.

void* operator new(std::size_t size)
{
    for (;;) {
        if (void* const block = __wrap_malloc(size > 0 ? size : 1)) return block;
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
