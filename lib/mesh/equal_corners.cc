#include "mesh/equal_corners.h"

#include "core/uninitialized_vector.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

// Consecutive facets of a file mostly share corners. So equal corners are found within each piece of the file first,
// with a hash table that fits the processor's cache. The distinct corners of all pieces are then partitioned by hash,
// and equal ones are found within each partition. The result does not depend on the scheduling of threads.

namespace fettle::mesh {

namespace {

constexpr std::size_t kPieceFacets = 8192;
constexpr std::size_t kPartitions = 256; // by the highest bits of the hash
constexpr int kPartitionShift = 24;

template <typename T>
bool finite(const Corner<T>& corner)
{
    return std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
}

/// @param corner  must not contain -0, which equals +0 but has other bits
template <typename T>
std::uint32_t hash(const Corner<T>& corner)
{
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    std::uint64_t mixed = 0;
    for (const T coordinate : corner) {
        mixed ^= std::bit_cast<Bits>(coordinate);
        mixed *= 0x9e3779b97f4a7c15; // 2^64 / golden ratio: multiplicative hashing (Knuth)
        mixed ^= mixed >> 32;
    }
    return static_cast<std::uint32_t>(mixed);
}

/// Hash set of corners with open addressing. It stores their indices only, and clear() keeps its memory.
template <typename Index>
class CornerSet {
  public:
    /// Empties the set. @param max_size  number of indices to be added
    void clear(std::size_t max_size)
    {
        const std::size_t slots = std::bit_ceil(2 * max_size + 1);
        if (slots > capacity_) slots_ = std::make_unique_for_overwrite<Index[]>(capacity_ = slots);
        mask_ = slots - 1;
        std::fill_n(slots_.get(), slots, kEmpty);
    }

    /// Adds an index unless the set has one of an equal corner.
    /// @param equal  true for indices of an equal corner   @return  the index in the set
    template <typename Equal>
    Index add(Index index, std::uint32_t hash_of_corner, const Equal& equal)
    {
        for (std::size_t slot = hash_of_corner & mask_;; slot = (slot + 1) & mask_) {
            if (slots_[slot] == kEmpty) return slots_[slot] = index;
            if (equal(slots_[slot])) return slots_[slot];
        }
    }

  private:
    static constexpr Index kEmpty = std::numeric_limits<Index>::max();
    std::unique_ptr<Index[]> slots_;
    std::size_t capacity_ = 0, mask_ = 0;
};

/// Consecutive facets of the file. The distinct corners of all pieces, piece after piece, are numbered consecutively.
template <typename T>
struct Piece {
    std::vector<Corner<T>> corners; ///< distinct corners in order of appearance
    std::size_t facets = 0;         ///< number of facets with finite corners
    std::uint32_t first = 0;        ///< number of the first corner
    std::uint32_t vertices = 0;     ///< number of corners that are in no earlier piece
    /// Number of corners in each partition; in partition_by_hash() the position at which the next of them goes.
    std::array<std::uint32_t, kPartitions> partitions{};
};

template <typename T>
struct NumberedCorner {
    Corner<T> corner;
    std::uint32_t number; ///< among the distinct corners of all pieces
};

/// Memory that a thread reuses for all its pieces.
template <typename T>
struct PieceBuffers {
    std::vector<Corner<T>> corners = std::vector<Corner<T>>(3 * kPieceFacets);
    std::vector<Corner<T>> distinct = std::vector<Corner<T>>(3 * kPieceFacets);
    CornerSet<std::uint16_t> set;
};

/// Finds the equal corners of a piece.
/// @param facets  number of facets whose corners are in the buffers
/// @param triangles  receives the facets' corners as indices of the piece's distinct corners
template <typename T>
Piece<T> weld_piece(std::size_t facets, PieceBuffers<T>& buffers, int* triangles)
{
    static_assert(3 * kPieceFacets < std::numeric_limits<std::uint16_t>::max());
    Piece<T> piece;
    buffers.set.clear(3 * facets);
    std::size_t count = 0;
    for (std::size_t f = 0; f < facets; ++f) {
        Corner<T>* const facet = &buffers.corners[3 * f];
        if (!finite(facet[0]) || !finite(facet[1]) || !finite(facet[2])) continue;
        for (int k = 0; k < 3; ++k) {
            Corner<T>& corner = facet[k];
            for (T& coordinate : corner) coordinate += 0; // turns -0 into +0
            const std::uint32_t hash_of_corner = hash(corner);
            const auto equal = [&](std::uint16_t other) { return buffers.distinct[other] == corner; };
            const auto index = buffers.set.add(static_cast<std::uint16_t>(count), hash_of_corner, equal);
            if (index == count) {
                buffers.distinct[count++] = corner;
                ++piece.partitions[hash_of_corner >> kPartitionShift];
            }
            *triangles++ = index;
        }
        ++piece.facets;
    }
    piece.corners.assign(buffers.distinct.begin(), buffers.distinct.begin() + count);
    return piece;
}

template <typename T>
std::vector<Piece<T>> weld_pieces(std::size_t facets, const CornerSource<T>& corners, Eigen::Matrix3Xi& triangles)
{
    std::vector<Piece<T>> pieces((facets + kPieceFacets - 1) / kPieceFacets);
    tbb::enumerable_thread_specific<PieceBuffers<T>> thread_buffers;
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        PieceBuffers<T>& buffers = thread_buffers.local();
        const std::size_t first = p * kPieceFacets, count = std::min(kPieceFacets, facets - first);
        corners(first, count, buffers.corners.data());
        pieces[p] = weld_piece(count, buffers, triangles.data() + 3 * first);
    });
    return pieces;
}

/// The distinct corners of all pieces, sorted by partition, within a partition in the order of the pieces.
template <typename T>
struct Partitions {
    core::UninitializedVector<NumberedCorner<T>> corners;
    std::array<std::size_t, kPartitions + 1> first{}; ///< position of each partition's first corner, and the total
};

template <typename T>
Partitions<T> partition_by_hash(std::vector<Piece<T>>& pieces)
{
    Partitions<T> partitions;
    std::uint32_t count = 0;
    for (Piece<T>& piece : pieces) {
        piece.first = count;
        count += static_cast<std::uint32_t>(piece.corners.size());
    }
    std::uint32_t position = 0;
    for (std::size_t p = 0; p < kPartitions; ++p) {
        partitions.first[p] = position;
        for (Piece<T>& piece : pieces) position += std::exchange(piece.partitions[p], position);
    }
    partitions.first[kPartitions] = count;
    partitions.corners.resize(count);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        std::uint32_t number = pieces[p].first;
        for (const Corner<T>& corner : pieces[p].corners)
            partitions.corners[pieces[p].partitions[hash(corner) >> kPartitionShift]++] = {corner, number++};
    });
    return partitions;
}

/// For each corner number, the lowest number of an equal corner.
template <typename T>
core::UninitializedVector<std::uint32_t> find_first_equal(const Partitions<T>& partitions)
{
    core::UninitializedVector<std::uint32_t> first(partitions.first[kPartitions]);
    tbb::enumerable_thread_specific<CornerSet<std::uint32_t>> thread_sets;
    tbb::parallel_for(std::size_t{0}, kPartitions, [&](std::size_t p) {
        const NumberedCorner<T>* const corners = partitions.corners.data() + partitions.first[p];
        const auto count = static_cast<std::uint32_t>(partitions.first[p + 1] - partitions.first[p]);
        CornerSet<std::uint32_t>& set = thread_sets.local();
        set.clear(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto equal = [&](std::uint32_t other) { return corners[other].corner == corners[i].corner; };
            first[corners[i].number] = corners[set.add(i, hash(corners[i].corner), equal)].number;
        }
    });
    return first;
}

constexpr std::uint32_t kIsVertex = 1u << 31; // flags a vertex index among corner numbers

/// Makes a vertex of the first of equal corners, in the order of the corners.
/// @param first  find_first_equal(); for the corners that became vertices it is replaced by kIsVertex | vertex
template <typename T>
Eigen::Matrix3Xd make_vertices(std::vector<Piece<T>>& pieces, std::uint32_t* first)
{
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        Piece<T>& piece = pieces[p];
        for (std::uint32_t c = 0; c < piece.corners.size(); ++c)
            piece.vertices += first[piece.first + c] == piece.first + c;
    });
    std::vector<std::uint32_t> next = {0};
    for (const Piece<T>& piece : pieces) next.push_back(next.back() + piece.vertices);
    Eigen::Matrix3Xd vertices(3, next.back());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        const Piece<T>& piece = pieces[p];
        std::uint32_t vertex = next[p];
        for (std::uint32_t c = 0; c < piece.corners.size(); ++c) {
            std::uint32_t& number = first[piece.first + c];
            if (number != piece.first + c) continue;
            const Corner<T>& corner = piece.corners[c];
            vertices.col(vertex) << corner[0], corner[1], corner[2];
            number = kIsVertex | vertex++;
        }
    });
    return vertices;
}

/// Replaces indices of a piece's distinct corners by those of vertices.
template <typename T>
void to_vertex_indices(const Piece<T>& piece, const std::uint32_t* first, int* triangles)
{
    std::vector<int> vertices(piece.corners.size());
    for (std::uint32_t c = 0; c < vertices.size(); ++c) {
        const std::uint32_t number = first[piece.first + c];
        vertices[c] = static_cast<int>((number & kIsVertex ? number : first[number]) & ~kIsVertex);
    }
    for (std::size_t k = 0; k < 3 * piece.facets; ++k) triangles[k] = vertices[triangles[k]];
}

} // namespace

template <typename T>
Mesh weld_facets(std::size_t facets, const CornerSource<T>& corners, MeshRepair& repair)
{
    Mesh mesh;
    mesh.triangles.resize(3, facets);
    std::vector<Piece<T>> pieces = weld_pieces(facets, corners, mesh.triangles);
    core::UninitializedVector<std::uint32_t> first = find_first_equal(partition_by_hash(pieces));
    mesh.vertices = make_vertices(pieces, first.data());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        to_vertex_indices(pieces[p], first.data(), mesh.triangles.data() + 3 * p * kPieceFacets);
    });
    std::size_t kept = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) { // closes the gaps that dropped facets leave at the ends of pieces
        int* const piece = mesh.triangles.data() + 3 * p * kPieceFacets;
        if (kept < p * kPieceFacets) std::copy_n(piece, 3 * pieces[p].facets, mesh.triangles.data() + 3 * kept);
        kept += pieces[p].facets;
    }
    if (kept < facets) mesh.triangles.conservativeResize(3, kept);
    repair.dropped_triangles += facets - kept;
    repair.welded_vertices = static_cast<Eigen::Index>(3 * kept) - mesh.vertices.cols();
    return mesh;
}

template Mesh weld_facets(std::size_t facets, const CornerSource<float>& corners, MeshRepair& repair);
template Mesh weld_facets(std::size_t facets, const CornerSource<double>& corners, MeshRepair& repair);

} // namespace fettle::mesh
