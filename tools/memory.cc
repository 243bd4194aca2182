// How every tool takes memory from the system. The kernel maps a page when it is first touched, and the pages of 4 kB
// that it maps by default cost a quarter of fettle-compare's time over a million triangles, and half of fettle-clean's.
//
// Large blocks get huge pages of 2 MB, which on Debian the kernel gives only to programs that ask for them. The C
// library asks if its environment says so (GLIBC_TUNABLES=glibc.malloc.hugetlb=1), which a tool cannot set for itself.
// The linker leads the calls of malloc(), Eigen's among them, to __wrap_malloc() (--wrap=malloc).
//
// Smaller blocks lie in heaps: one for the main thread, one for each of the others. The heaps get huge pages, too, and
// the main one grows in steps that hold some: a chain of tools over a casting takes a third less time for it.
//
// What is freed is kept for the next block. By default malloc() gives back what is free at the end of its heap from
// 128 kB on, and takes it again: a fit of 30 touches did so in every step, for a third of its time. It raises its
// limits when large blocks are freed; here they are from the start where it would raise them to.

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
constexpr std::size_t kMinHugeBlock = 2 * kHugePage; // holds a whole huge page wherever it begins
constexpr int kMaxHeapBlock = 32 << 20;              // malloc()'s own maximum; larger ones are mapped one by one
constexpr int kHeapStep = 32 << 20;                  // by which a heap grows: of address space, not of memory
constexpr std::uintptr_t kThreadHeap = std::uintptr_t{64} << 20; // address space of a thread's heap, and its alignment

std::atomic<std::uintptr_t> known_heap_end; // of the main thread's heap

std::uintptr_t heap_end() { return reinterpret_cast<std::uintptr_t>(sbrk(0)); }

[[gnu::constructor]] void set_limits()
{
    known_heap_end = heap_end();
    mallopt(M_MMAP_THRESHOLD, kMaxHeapBlock);
    mallopt(M_TRIM_THRESHOLD, 2 * kMaxHeapBlock); // twice the other limit, as malloc() itself has it
    mallopt(M_TOP_PAD, kHeapStep);
}

/// Asks for huge pages in what a range holds of them. Where the kernel has none, or part of the range is not mapped,
/// madvise() fails and that part stays as it is; errno is restored, as a caller may be about to say what it was.
void ask_for_huge_pages(std::uintptr_t begin, std::uintptr_t end)
{
    begin = (begin + kHugePage - 1) / kHugePage * kHugePage;
    end = end / kHugePage * kHugePage;
    if (begin >= end) return;
    const int error = errno;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    errno = error;
}

/// Asks for huge pages in what the main thread's heap has grown by since the last call.
void ask_for_huge_main_heap()
{
    const std::uintptr_t end = heap_end(), before = known_heap_end.load(std::memory_order_relaxed);
    if (end == before) return;
    known_heap_end.store(end, std::memory_order_relaxed);
    ask_for_huge_pages(before / kHugePage * kHugePage, end); // it may have grown to the end of the page of `before`
}

/// Asks for huge pages in the heap that the first block of a thread is in.
void ask_for_huge_thread_heap(std::uintptr_t block)
{
    thread_local bool has_asked = false;
    if (has_asked) return;
    has_asked = true;
    const std::uintptr_t begin = block / kThreadHeap * kThreadHeap;
    ask_for_huge_pages(begin, begin + kThreadHeap);
}

} // namespace

extern "C" {

void* __real_malloc(std::size_t size);

void* __wrap_malloc(std::size_t size)
{
    void* const block = __real_malloc(size);
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    if (size >= kMinHugeBlock && block) ask_for_huge_pages(address, address + size);
    ask_for_huge_main_heap();
    ask_for_huge_thread_heap(address);
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
