#include "driver/protocol/constants.h"

namespace gonio::driver {

std::string statusName(std::uint16_t code) {
    switch (code) {
        case status::kOk: return "OK";
        case status::kPending: return "PENDING";
        case status::kBadArg: return "BAD_ARG";
        case status::kBadState: return "BAD_STATE";
        case status::kBadCrc: return "BAD_CRC";
        case status::kUnsupported: return "UNSUPPORTED";
        case status::kNotOwner: return "NOT_OWNER";
        case status::kBusy: return "BUSY";
        case status::kBadSeq: return "BAD_SEQ";
        case status::kInterlock: return "INTERLOCK";
        case status::kOverTemp: return "OVER_TEMP";
        case status::kLedOpen: return "LED_OPEN";
        case status::kLedDrift: return "LED_DRIFT";
        case status::kSensor: return "SENSOR";
        case status::kHeartbeat: return "HEARTBEAT";
        case status::kLink: return "LINK";
        case status::kOverrun: return "OVERRUN";
        case status::kFrameGone: return "FRAME_GONE";
        case status::kBadRange: return "BAD_RANGE";
        case status::kInternal: return "INTERNAL";
        default: return "status " + std::to_string(code);
    }
}

std::string opName(Op op) {
    switch (op) {
        case Op::Ping: return "PING";
        case Op::SetLed: return "SET_LED";
        case Op::SetExposure: return "SET_EXPOSURE";
        case Op::SetFormat: return "SET_FORMAT";
        case Op::Arm: return "ARM";
        case Op::Trigger: return "TRIGGER";
        case Op::Abort: return "ABORT";
        case Op::Resend: return "RESEND";
        case Op::Flush: return "FLUSH";
        case Op::SyncTime: return "SYNC_TIME";
        case Op::ClearFault: return "CLEAR_FAULT";
        case Op::Reboot: return "REBOOT";
    }
    return "op " + std::to_string(static_cast<int>(op));
}

}  // namespace gonio::driver
