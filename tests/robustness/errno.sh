# A block that malloc() returns leaves errno as it was: a tool that names the reason of a failure makes text of it first.
cat >errno.cc <<'END'
#include <cerrno>
#include <cstdlib>
#include <thread>

bool keeps_errno(std::size_t size)
{
    errno = ENOENT;
    const volatile auto block = std::malloc(size); // kept, so that the heap grows
    return block != nullptr && errno == ENOENT;
}

int main()
{
    bool keeps = keeps_errno(100); // the main thread's first
    std::thread([&] { keeps &= keeps_errno(100); }).join();
    for (int i = 0; i < 100; ++i) keeps &= keeps_errno(1 << 20); // more than a step of the heap
    keeps &= keeps_errno(64 << 20);                             // mapped by itself
    return keeps ? 0 : 1;
}
END
${CXX:-g++} -std=c++20 -O1 -Wall -Wextra -Wl,--wrap=malloc errno.cc "$HERE/../../tools/memory.cc" -o errno -pthread
./errno
