#include "daemon/digest.h"

#include <openssl/evp.h>

#include <array>

namespace gonio::daemon {

std::string digestOf(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
        text += kHex[digest[i] / 16U];
        text += kHex[digest[i] % 16U];
    }
    return text;
}

}  // namespace gonio::daemon
