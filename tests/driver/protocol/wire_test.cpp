#include "driver/protocol/wire.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace gonio::driver {
namespace {

template <class T>
class Wire : public testing::Test {};
using Fields = testing::Types<std::uint8_t,
                              std::uint16_t,
                              std::uint32_t,
                              std::uint64_t,
                              std::int16_t,
                              std::int32_t,
                              std::int64_t>;
TYPED_TEST_SUITE(Wire, Fields);

TYPED_TEST(Wire, EndsRoundTripAtEveryOffsetAndTouchNothingElse) {
    using Limits = std::numeric_limits<TypeParam>;
    for (const TypeParam value : {Limits::min(), Limits::max(), TypeParam(1), TypeParam(0)}) {
        for (std::size_t offset = 0; offset + sizeof(TypeParam) <= 16; ++offset) {
            std::array<std::uint8_t, 16> bytes{};
            bytes.fill(0xA5);
            put(bytes, offset, value);
            EXPECT_EQ(get<TypeParam>(bytes, offset), value);
            for (std::size_t i = 0; i < bytes.size(); ++i) {
                if (i >= offset && i < offset + sizeof(TypeParam)) continue;
                EXPECT_EQ(bytes[i], 0xA5);
            }
        }
    }
}

TEST(WireOrder, IsLittleEndian) {
    std::array<std::uint8_t, 8> bytes{};
    put(bytes, 0, std::uint64_t{0x1122334455667788});
    EXPECT_EQ(bytes, (std::array<std::uint8_t, 8>{0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11}));
    EXPECT_EQ(get<std::uint16_t>(bytes, 1), 0x6677);
    put(bytes, 2, std::int16_t{-2});
    EXPECT_EQ(bytes[2], 0xFE);
    EXPECT_EQ(bytes[3], 0xFF);
}

}  // namespace
}  // namespace gonio::driver
