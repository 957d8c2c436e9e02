#include "pictures.hpp"

#include <catch2/catch.hpp>
#include <cstdint>
#include <pugixml.hpp>
#include <string_view>

namespace downwash::test {
namespace {

void add_texts(const pugi::xml_node& node, std::string& texts) {
    for (const pugi::xml_node& child : node.children()) {
        if (std::string_view(child.name()) == "text") {
            texts += std::string(child.text().get()) + "\n";
        }
        add_texts(child, texts);
    }
}

}  // namespace

std::string svg_texts(const std::string& picture) {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(picture.data(), picture.size());
    INFO(result.description());
    CHECK(result);
    CHECK(std::string_view(document.document_element().name()) == "svg");
    std::string texts;
    add_texts(document, texts);
    return texts;
}

std::array<unsigned, 2> png_size(const std::string& picture) {
    constexpr std::string_view signature("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    if (picture.size() < 24 || picture.substr(0, signature.size()) != signature) {
        return {0, 0};
    }
    const auto number = [&](std::size_t at) {
        unsigned value = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            value = value * 256 + static_cast<std::uint8_t>(picture[at + i]);
        }
        return value;
    };
    return {number(16), number(20)};
}

double area_of(const Ring& ring) {
    double twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
        twice += a.x_m * b.z_m - a.z_m * b.x_m;
    }
    return twice / 2;
}

const std::array<std::string, 13>& hostile_texts() {
    static const std::array<std::string, 13> texts{
        "`touch downwash-was-here`",
        "'; system('touch downwash-was-here'); '",
        "''.system('touch downwash-was-here').''",
        "'.system('touch downwash-was-here').'",
        "\"; system(\"touch downwash-was-here\"); \"",
        "\nsystem('touch downwash-was-here')\n",
        "\r\n!touch downwash-was-here\r\n",
        "\\\n!touch downwash-was-here",
        "'\nEND_OF_DATA\n!touch downwash-was-here\n",
        "@system {/Symbol a}_b^c %s %g $HOME #",
        "</text><script>alert(1)</script> & < > ]]>",
        std::string("\x01\x1b[31m\x7f\xff\xc3(\xed\xa0\x80\0end", 17),
        "Über-Brücke 桥 \xef\xbf\xbf",
    };
    return texts;
}

}  // namespace downwash::test
