#include "downwash/base/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <memory>
#include <stdexcept>

namespace downwash {

std::string sha256_hex(std::string_view bytes) {
    // Looked up once: EVP_sha256() makes every call look it up again.
    static const std::unique_ptr<EVP_MD, decltype(&EVP_MD_free)> algorithm(EVP_MD_fetch(nullptr, "SHA256", nullptr),
                                                                           EVP_MD_free);
    std::array<unsigned char, 32> digest;
    unsigned int size = 0;
    if (!algorithm || EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, algorithm.get(), nullptr) != 1) {
        throw std::runtime_error("libcrypto offers no SHA-256");
    }
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += digits[byte >> 4U];
        text += digits[byte & 15U];
    }
    return text;
}

}  // namespace downwash
