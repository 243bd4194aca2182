#include "mesh/equal_corners.h"

#include "core/large_array.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

// Facets that follow each other in a file mostly share corners. So equal corners are found among the facets of a piece
// of the file first, in a table that stays in the processor's cache; what is left of all pieces is then dealt out by
// hash, and found in such tables again. Nothing depends on which thread does what.

namespace fettle {

namespace {

constexpr std::size_t kPiece = 8192; // facets
constexpr std::size_t kParts = 256;  // by the first bits of the hash
constexpr int kPartShift = 24;

template <typename T>
bool finite(const Corner<T>& corner)
{
    return std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
}

/// @param corner  without -0, which equals +0 but differs in its bits
template <typename T>
std::uint32_t hash(const Corner<T>& corner)
{
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    std::uint64_t mixed = 0;
    for (const T coordinate : corner) {
        mixed ^= std::bit_cast<Bits>(coordinate);
        mixed *= 0x9e3779b97f4a7c15; // 2^64 / golden ratio: spreads neighbours (Knuth)
        mixed ^= mixed >> 32;
    }
    return static_cast<std::uint32_t>(mixed);
}

/// A hash table with open addressing, of numbers that stand for corners. It is used again and again.
template <typename Number>
class Table {
  public:
    /// Makes it empty. @param most  numbers that will be added
    void clear(std::size_t most)
    {
        const std::size_t slots = std::bit_ceil(2 * most + 1);
        if (slots > room_) slots_ = std::make_unique_for_overwrite<Number[]>(room_ = slots);
        mask_ = slots - 1;
        std::fill_n(slots_.get(), slots, kEmpty);
    }

    /// @param equal  does a number in the table stand for the same corner?   @return  that one, or `number` if there is
    /// none: then it stands in the table from now on
    template <typename Equal>
    Number add(Number number, std::uint32_t hash_of_corner, const Equal& equal)
    {
        for (std::size_t slot = hash_of_corner & mask_;; slot = (slot + 1) & mask_) {
            if (slots_[slot] == kEmpty) return slots_[slot] = number;
            if (equal(slots_[slot])) return slots_[slot];
        }
    }

  private:
    static constexpr Number kEmpty = std::numeric_limits<Number>::max();
    std::unique_ptr<Number[]> slots_;
    std::size_t room_ = 0, mask_ = 0;
};

/// Some facets that follow each other in the file.
template <typename T>
struct Piece {
    std::vector<Corner<T>> corners;            ///< that differ, as they first appear
    std::size_t facets = 0;                    ///< without those that are left out
    std::uint32_t first = 0;                   ///< of all pieces' corners, the number of its first one
    std::uint32_t vertices = 0;                ///< how many of its corners stand in no piece before it
    std::array<std::uint32_t, kParts> parts{}; ///< its corners in each part; then where they go
};

/// A corner on its way to a part.
template <typename T>
struct Dealt {
    Corner<T> corner;
    std::uint32_t number; ///< of all pieces' corners
};

/// What a thread needs to look through a piece.
template <typename T>
struct PieceRoom {
    std::vector<Corner<T>> corners = std::vector<Corner<T>>(3 * kPiece);
    std::vector<Corner<T>> distinct = std::vector<Corner<T>>(3 * kPiece);
    Table<std::uint16_t> table;
};

/// Finds the equal corners of a piece. @param triangles  gets the facets' corners, by number in the piece
template <typename T>
Piece<T> look_through(std::size_t facets, PieceRoom<T>& room, int* triangles)
{
    static_assert(3 * kPiece < std::numeric_limits<std::uint16_t>::max());
    Piece<T> piece;
    room.table.clear(3 * facets);
    std::size_t count = 0;
    for (std::size_t f = 0; f < facets; ++f) {
        Corner<T>* const facet = &room.corners[3 * f];
        if (!finite(facet[0]) || !finite(facet[1]) || !finite(facet[2])) continue;
        for (int k = 0; k < 3; ++k) {
            Corner<T>& corner = facet[k];
            for (T& coordinate : corner) coordinate += 0; // no negative zeros
            const std::uint32_t hash_of_corner = hash(corner);
            const auto number = room.table.add(static_cast<std::uint16_t>(count), hash_of_corner,
                                               [&](std::uint16_t other) { return room.distinct[other] == corner; });
            if (number == count) {
                room.distinct[count++] = corner;
                ++piece.parts[hash_of_corner >> kPartShift];
            }
            *triangles++ = number;
        }
        ++piece.facets;
    }
    piece.corners.assign(room.distinct.begin(), room.distinct.begin() + static_cast<std::ptrdiff_t>(count));
    return piece;
}

template <typename T>
std::vector<Piece<T>> pieces_of(std::size_t facets, const CornerSource<T>& corners, Eigen::Matrix3Xi& triangles)
{
    std::vector<Piece<T>> pieces((facets + kPiece - 1) / kPiece);
    tbb::enumerable_thread_specific<PieceRoom<T>> rooms;
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        PieceRoom<T>& room = rooms.local();
        const std::size_t first = p * kPiece, count = std::min(kPiece, facets - first);
        corners(first, count, room.corners.data());
        pieces[p] = look_through(count, room, triangles.data() + 3 * first);
    });
    return pieces;
}

/// The corners of all pieces, part by part, each part in the order of the pieces.
template <typename T>
struct Parts {
    LargeArray<Dealt<T>> corners;
    std::array<std::size_t, kParts + 1> first{}; ///< of each part
};

template <typename T>
Parts<T> deal_out(std::vector<Piece<T>>& pieces)
{
    Parts<T> parts;
    std::uint32_t count = 0;
    for (Piece<T>& piece : pieces) {
        piece.first = count;
        count += static_cast<std::uint32_t>(piece.corners.size());
    }
    std::uint32_t place = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
        parts.first[part] = place;
        for (Piece<T>& piece : pieces) {
            const std::uint32_t here = piece.parts[part];
            piece.parts[part] = place;
            place += here;
        }
    }
    parts.first[kParts] = count;
    parts.corners.resize(count);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        std::uint32_t number = pieces[p].first;
        for (const Corner<T>& corner : pieces[p].corners)
            parts.corners[pieces[p].parts[hash(corner) >> kPartShift]++] = {corner, number++};
    });
    return parts;
}

/// Of each corner of the pieces the number of the first one that equals it.
template <typename T>
LargeArray<std::uint32_t> first_equal(const Parts<T>& parts)
{
    LargeArray<std::uint32_t> first(parts.first[kParts]);
    tbb::enumerable_thread_specific<Table<std::uint32_t>> tables;
    tbb::parallel_for(std::size_t{0}, kParts, [&](std::size_t p) {
        const Dealt<T>* const part = parts.corners.data() + parts.first[p];
        const auto count = static_cast<std::uint32_t>(parts.first[p + 1] - parts.first[p]);
        Table<std::uint32_t>& table = tables.local();
        table.clear(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t equal = table.add(
                i, hash(part[i].corner), [&](std::uint32_t other) { return part[other].corner == part[i].corner; });
            first[part[i].number] = part[equal].number;
        }
    });
    return first;
}

constexpr std::uint32_t kNumbered = 1u << 31; // a vertex, no corner

/// Makes the first of equal corners the next vertex. @param first  first_equal(); then, with kNumbered, the vertex of
/// such corners
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
    Eigen::Matrix3Xd vertices(3, static_cast<Eigen::Index>(next.back()));
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        const Piece<T>& piece = pieces[p];
        std::uint32_t vertex = next[p];
        for (std::uint32_t c = 0; c < piece.corners.size(); ++c) {
            std::uint32_t& number = first[piece.first + c];
            if (number != piece.first + c) continue;
            const Corner<T>& corner = piece.corners[c];
            vertices.col(vertex) << corner[0], corner[1], corner[2];
            number = kNumbered | vertex++;
        }
    });
    return vertices;
}

/// Turns the numbers of a piece's corners into those of vertices.
template <typename T>
void name_vertices(const Piece<T>& piece, const std::uint32_t* first, int* triangles)
{
    std::vector<int> vertices(piece.corners.size());
    for (std::uint32_t c = 0; c < vertices.size(); ++c) {
        const std::uint32_t number = first[piece.first + c];
        vertices[c] = static_cast<int>((number & kNumbered ? number : first[number]) & ~kNumbered);
    }
    for (std::size_t k = 0; k < 3 * piece.facets; ++k) triangles[k] = vertices[static_cast<std::size_t>(triangles[k])];
}

} // namespace

template <typename T>
Mesh welded(std::size_t facets, const CornerSource<T>& corners, MeshRepair& repair)
{
    Mesh mesh;
    mesh.triangles.resize(3, static_cast<Eigen::Index>(facets));
    std::vector<Piece<T>> pieces = pieces_of(facets, corners, mesh.triangles);
    LargeArray<std::uint32_t> first = first_equal(deal_out(pieces));
    mesh.vertices = make_vertices(pieces, first.data());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
        name_vertices(pieces[p], first.data(), mesh.triangles.data() + 3 * p * kPiece);
    });
    std::size_t kept = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) { // what was left out leaves a gap behind its piece
        int* const piece = mesh.triangles.data() + 3 * p * kPiece;
        if (kept < p * kPiece) std::copy_n(piece, 3 * pieces[p].facets, mesh.triangles.data() + 3 * kept);
        kept += pieces[p].facets;
    }
    if (kept < facets) mesh.triangles.conservativeResize(3, static_cast<Eigen::Index>(kept));
    repair.dropped_triangles += static_cast<Eigen::Index>(facets - kept);
    repair.welded_vertices = static_cast<Eigen::Index>(3 * kept) - mesh.vertices.cols();
    return mesh;
}

template Mesh welded(std::size_t facets, const CornerSource<float>& corners, MeshRepair& repair);
template Mesh welded(std::size_t facets, const CornerSource<double>& corners, MeshRepair& repair);

} // namespace fettle
