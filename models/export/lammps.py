"""The exported C as a normal model of LAMMPS: a class that is built with it.

LAMMPS, pair_style granular and fix wall/gran; src/GRANULAR/gran_sub_mod_normal.h, whose class a
normal model derives from, of 2022 to 2026.
"""

from __future__ import annotations

STYLE = "gran_sub_mod_dentscope"
"""Name of both files: LAMMPS finds its models by how they begin."""

_CLASS = "GranSubModNormalDentscope"


def lammps_header() -> str:
    """Declaration of the class, and the line by which LAMMPS lists it."""
    return f"""/* -*- c++ -*-
   Normal model `dentscope` of LAMMPS: elastic-plastic contact after dentscope_contact.h.

   Put gran_sub_mod_dentscope.h and .cpp, dentscope_contact.h and .c into LAMMPS's src/ and build
   it with its package GRANULAR. Units si; the two bodies of a contact, the second a wall or sphere:

     ... dentscope E_1 nu_1 Sy_1 E_2 nu_2 Sy_2 tangential linear_nohistory 0 0 damping velocity

   NULL for E is a rigid body, for Sy one that never yields. Types whose pair is not stated take
   body 1 of the lower type and body 2 of the higher. The model has no damping: what does not come
   back is plastic work. A contact keeps its dent until it opens; a later one meets fresh metal.
*/
#ifdef GRAN_SUB_MOD_CLASS
// clang-format off
GranSubModStyle(dentscope,{_CLASS},NORMAL);
// clang-format on
#else

#ifndef GRAN_SUB_MOD_DENTSCOPE_H
#define GRAN_SUB_MOD_DENTSCOPE_H

#include "gran_sub_mod_normal.h"

namespace LAMMPS_NS {{
namespace Granular_NS {{

class {_CLASS} : public GranSubModNormal {{
 public:
  {_CLASS}(class GranularModel *, class LAMMPS *);
  void coeffs_to_local() override;
  void mix_coeffs(double *, double *) override;
  double calculate_contact_radius() override;
  double calculate_forces() override;

 private:
  double body[6];
}};

}}    // namespace Granular_NS
}}    // namespace LAMMPS_NS

#endif
#endif
"""


def lammps_source() -> str:
    """Definition of the class; it includes the exported C, which LAMMPS itself would not build."""
    return f"""/* See {STYLE}.h */
#include "{STYLE}.h"

#include "dentscope_contact.c"
#include "error.h"
#include "granular_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace Granular_NS;

{_CLASS}::{_CLASS}(GranularModel *gm, LAMMPS *lmp) :
    GranSubModNormal(gm, lmp)
{{
  num_coeffs = 6;
  size_history = 4;
  damp = 0.0;
  // what a contact keeps has no direction: it stays as it is where its two particles change places
  nondefault_history_transfer = 1;
  transfer_history_factor = new double[size_history];
  std::fill_n(transfer_history_factor, size_history, 1.0);
}}

void {_CLASS}::coeffs_to_local()
{{
  for (int k = 0; k < 6; k++) {{
    const bool ratio = k % 3 == 1;
    // LAMMPS reads NULL as -1
    if (coeffs[k] < 0.0)
      body[k] = ratio ? 0.0 : std::numeric_limits<double>::infinity();
    else
      body[k] = coeffs[k];
    if (ratio ? body[k] >= 0.5 : body[k] == 0.0)
      error->all(FLERR, "Illegal dentscope normal model: E and Sy above 0, nu below 0.5");
  }}
  if (std::isinf(body[0]) && std::isinf(body[3]))
    error->all(FLERR, "Illegal dentscope normal model: both bodies are rigid");
}}

void {_CLASS}::mix_coeffs(double *icoeffs, double *jcoeffs)
{{
  std::copy_n(icoeffs, 3, coeffs);
  std::copy_n(jcoeffs + 3, 3, coeffs + 3);
  coeffs_to_local();
}}

// as the law recovers: the circle shrinks with the root of what is left of the approach
double {_CLASS}::calculate_contact_radius()
{{
  const double deepest = std::max(gm->history[history_index], gm->delta);
  const dentscope_result r = dentscope_contact(body[0], body[1], body[2], body[3], body[4],
                                               body[5], gm->Reff, deepest);
  const double residual = r.residual_s + r.residual_f;
  if (gm->delta <= residual) return 0.0;
  return r.contact_radius * std::sqrt((gm->delta - residual) / (deepest - residual));
}}

double {_CLASS}::calculate_forces()
{{
  double *kept = gm->history + history_index;
  dentscope_history history = {{kept[0], kept[1], kept[2], kept[3]}};
  const double force = dentscope_force(body[0], body[1], body[2], body[3], body[4], body[5],
                                       gm->Reff, gm->delta, &history);
  if (gm->history_update) {{
    kept[0] = history.depth;
    kept[1] = history.force;
    kept[2] = history.residual;
    kept[3] = history.exponent;
  }}
  return force;
}}
"""
