# What is installed: every tool runs and has its manual page and completion; nothing else lands outside the prefix.
make -s -C "$HERE/../.." install B="$BUILD" DESTDIR="$PWD/stage" PREFIX=/opt/fettle >&2
test "$(ls stage)" = opt && test "$(ls stage/opt)" = fettle
stage=$PWD/stage
cd stage/opt/fettle
for tool in bin/*; do
    name=$(basename "$tool")
    "$tool" --version | grep -q "^$name [0-9]"
    grep -q "^\.TH" "share/man/man1/$name.1"
    test -e "share/bash-completion/completions/$name"
done
test "$(ls bin)" = "$(ls "$BUILD/bin")"
# libfettle-dev does not depend on Boost.
test -z "$(grep -rl '#include <boost/' include)"

# Completion offers options, and the words of an option.
cat >ask <<'END'
_init_completion() { cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}; }
_filedir() { :; }
. share/bash-completion/completions/fettle-compare
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_fettle "$1"
echo "${COMPREPLY[*]}"
END
test "$(bash ask fettle-compare --tol)" = --tolerance
test "$(bash ask fettle-compare --mode "")" = "normal z direction"
test "$(bash ask fettle-fit --method cyl)" = cylinder
test "$(bash ask fettle he)" = help
test "$(bash ask fettle help al)" = align

cd "$OLDPWD"
# Another program uses the installed library.
export PKG_CONFIG_PATH=$stage/opt/fettle/lib/pkgconfig CMAKE_PREFIX_PATH=$stage/opt/fettle
"$HERE/../../examples/signed-distance/try" --define-prefix >&2

# And its bridge to PCL, which is suggested beside it: a filter's indices choose points with their fields. Reference: a point 5 off four others.
cat >far.cc <<'END'
#include "cloud/pcl.h"
#include "cloud/pcd.h"
#include <pcl/filters/radius_outlier_removal.h>
#include <iostream>

int main(int, char** argv)
{
    const fettle::cloud::Cloud cloud = fettle::cloud::read_cloud(argv[1]).cloud;
    const Eigen::Vector3d centre = cloud.xyz.rowwise().mean();
    pcl::RadiusOutlierRemoval<pcl::PointXYZ> filter;
    filter.setInputCloud(fettle::cloud::to_pcl(cloud.xyz, centre));
    filter.setRadiusSearch(2);
    filter.setMinNeighborsInRadius(2);
    pcl::Indices kept;
    filter.filter(kept);
    const fettle::cloud::Cloud near = fettle::cloud::select_points(cloud, {kept.begin(), kept.end()});
    std::cout << near.size() << ' ' << fettle::cloud::field(near, "label").sum() << '\n';
}
END
printf '%s\n' 'x y z label' '1000000 0 0 1' '1000001 0 0 2' '1000000 1 0 3' '1000001 1 0 4' '1000005 0 0 5' >five.xyz
read -ra flags <<<"$(pkg-config --define-prefix --cflags --libs fettle)"
${CXX:-g++} -std=c++20 far.cc -isystem "$(echo /usr/include/pcl-1.*)" "${flags[@]}" -lpcl_filters -lpcl_search -lpcl_kdtree -lpcl_common -o far
test "$(./far five.xyz)" = '4 10'
