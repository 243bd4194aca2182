# All headers of the library stand together in one file, in either order: no two of them give one name to two things, and
# none leans on what another has included. Each one alone: make includes.
cd "$HERE/../.."
for order in cat tac; do
    ls lib/*/*.h | sed 's|^lib/\(.*\)|#include "\1"|' | $order |
        ${CXX:-g++} -std=c++20 -Wall -Wextra -Ilib -isystem /usr/include/eigen3 -isystem "$(echo /usr/include/pcl-1.*)" -isystem /usr/include/opencv4 -x c++ -fsyntax-only -
done
