#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/mesh_sides.hpp"

/// The bytes as STL and as OBJ; whatever is read has no corner but its own vertices, and its pieces can be told apart.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const char* name : {"mesh.stl", "mesh.obj"}) {
        try {
            const downwash::TriangleMesh mesh = downwash::parse_mesh({reinterpret_cast<const char*>(data), size}, name);
            for (const auto& corners : mesh.triangles) {
                for (const std::uint32_t corner : corners) {
                    if (corner >= mesh.vertices_m.size()) {
                        std::abort();
                    }
                }
            }
            const downwash::SurfaceFacts facts = downwash::sides_of(mesh).facts;
            if (facts.solid_pieces > facts.pieces || (facts.open_edges == 0) != (facts.solid_pieces == facts.pieces)) {
                std::abort();
            }
        } catch (const downwash::InputError&) {
        }
    }
    return 0;
}
