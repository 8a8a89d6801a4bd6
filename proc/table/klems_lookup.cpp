#include "proc/table/klems_lookup.h"

#include <cmath>
#include <set>

namespace gonio::proc {
namespace {

std::string described(const KlemsTable& table) {
    std::set<std::string> kinds;
    for (const KlemsMatrix& matrix : table.matrices) {
        kinds.insert(matrix.spectrum + (matrix.face == KlemsFace::Front ? " front" : " back"));
    }
    std::string text;
    for (const std::string& kind : kinds) text += (text.empty() ? "" : ", ") + kind;
    return text.empty() ? "nothing" : text;
}

bool fits(const KlemsTable& table, const KlemsMatrix& matrix) {
    return matrix.incident < table.bases.size() && matrix.outgoing < table.bases.size() &&
           matrix.f.size() == table.bases[matrix.incident].patchCount() *
                                  table.bases[matrix.outgoing].patchCount();
}

/// Azimuths of the basis: of the front, and for the back in a frame whose x is the front's -x.
Radians basisPhi(const Direction& direction, KlemsFace face) {
    return face == KlemsFace::Front ? direction.phi() : 180_deg - direction.phi();
}

}  // namespace

Result<KlemsLookup> KlemsLookup::over(KlemsTable table, const Choice& choice) {
    for (const KlemsMatrix& matrix : table.matrices) {
        if (!fits(table, matrix)) {
            return Error{ErrorKind::File, "look-up: a Klems matrix does not fit its bases"};
        }
    }
    if (table.find(choice.face, false, choice.spectrum) == nullptr &&
        table.find(choice.face, true, choice.spectrum) == nullptr) {
        return Error{ErrorKind::File,
                     "look-up: no " + choice.spectrum +
                         (choice.face == KlemsFace::Front ? " front" : " back") +
                         " data, the table has " + described(table)};
    }
    return KlemsLookup(std::move(table), choice);
}

KlemsLookup::KlemsLookup(KlemsTable table, const Choice& choice)
    : table_(std::move(table)), face_(choice.face) {
    const auto place = [&](bool transmission) -> std::optional<std::size_t> {
        const KlemsMatrix* found = table_.find(choice.face, transmission, choice.spectrum);
        if (found == nullptr) return std::nullopt;
        return static_cast<std::size_t>(found - table_.matrices.data());
    };
    reflection_ = place(false);
    transmission_ = place(true);
}

Answer KlemsLookup::answer(const LightView& pair) const {
    const bool below = pair.out.z() < 0;
    const auto& which = below ? transmission_ : reflection_;
    if (!pair.in.aboveHorizon() || pair.out.z() == 0 || !which) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const KlemsMatrix& matrix = table_.matrices[*which];
    const Radians inTheta = pair.in.theta();
    const Radians inPhi = basisPhi(pair.in, face_) + 180_deg;
    const Radians outTheta = below ? 180_deg - pair.out.theta() : pair.out.theta();
    const Radians outPhi = basisPhi(pair.out, face_);
    const KlemsBasis& incident = table_.bases[matrix.incident];
    const KlemsBasis& outgoing = table_.bases[matrix.outgoing];
    const auto in = incident.patchOf(inTheta, inPhi);
    const auto out = outgoing.patchOf(outTheta, outPhi);
    if (!in || !out) return Answer::none({}, Source::Interpolated);
    const bool centre = incident.isCentre(inTheta, inPhi) && outgoing.isCentre(outTheta, outPhi);
    const double f = table_.at(matrix, *in, *out);
    const Source source = centre ? Source::Measured : Source::Interpolated;
    if (std::isnan(f)) return Answer::none({}, source);
    Answer answer;
    answer.f = LedBands::all(f);
    answer.flags.set(centre ? Flag::Measured : Flag::Interpolated);
    answer.source = source;
    return answer;
}

}  // namespace gonio::proc
