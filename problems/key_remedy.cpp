#include "downwash/problems/key_remedy.hpp"

#include <algorithm>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/key_reference.hpp"

namespace downwash::problems {

KeyRemedy remedy_for_key(std::string_view key, const std::vector<std::string_view>& valid) {
    std::vector<std::string_view> without, other;
    for (const std::string_view name : valid) {
        const std::string_view stem = without_unit(name);
        if (stem.size() == name.size()) {
            continue;
        }
        if (key == stem) {
            without.push_back(name);
        } else if (is_stem_with_unit(key, stem)) {
            other.push_back(name);
        }
    }
    if (!without.empty()) {
        return {"its unit is missing; expected " + joined_names(without), without};
    }
    if (!other.empty()) {
        return {"its unit is wrong; expected " + joined_names(other), other};
    }
    const auto has = [&valid](std::string_view name) {
        return std::find(valid.begin(), valid.end(), name) != valid.end();
    };
    if (const std::string_view remark = out_of_plane_remark(key); !remark.empty() && (has("x_m") || has("vx_m_s"))) {
        return {std::string(remark), {}};
    }
    const std::string_view nearest = nearest_name(key, valid);
    if (!nearest.empty()) {
        return {"did you mean '" + std::string(nearest) + "'?", {nearest}};
    }
    return {"expected " + joined_names(valid), {}};
}

}  // namespace downwash::problems
