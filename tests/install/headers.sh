# All headers of the library stand together in one file, in either order: no two of them give one name to two things, and
# none leans on what another has included. Each one alone: make includes. Those of cad/ only where OpenCASCADE is; they are not installed, nor is job/boost_polygons.h.
cd "$HERE/../.."
occt=/usr/include/opencascade
absent=$([ -e $occt/Standard_Handle.hxx ] || echo '^lib/cad/')
# With FETTLE_DRAWS=few (make test) one order.
orders=(cat tac)
[ "${FETTLE_DRAWS:-all}" = all ] || orders=(cat)
for order in "${orders[@]}"; do
    ls lib/*/*.h | grep -v "${absent:-^none$}" | sed 's|^lib/\(.*\)|#include "\1"|' | $order |
        ${CXX:-g++} -std=c++20 -Wall -Wextra -Ilib -isystem /usr/include/eigen3 -isystem "$(echo /usr/include/pcl-1.*)" -isystem /usr/include/opencv4 -isystem $occt -x c++ -fsyntax-only -
done
