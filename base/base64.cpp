#include "downwash/base/base64.hpp"

#include <openssl/evp.h>

namespace downwash {

std::string base64_text(std::string_view bytes) {
    std::string text(base64_letters(bytes.size()) + 1, '\0');  // OpenSSL closes it with a zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), reinterpret_cast<const unsigned char*>(bytes.data()),
                    static_cast<int>(bytes.size()));
    text.pop_back();
    return text;
}

}  // namespace downwash
