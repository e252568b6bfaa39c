# Drag of each run over that of a fixed cylinder at its Reynolds number, from the curve of reference.csv (linear between the
# logarithms of its points); likewise the Strouhal number, where the curve has one.
function at(x, y, n, re,    k) {
  if (re < x[1] || re > x[n]) return 0
  for (k = 2; x[k] < re; k++) continue
  return exp(log(y[k - 1]) + (log(y[k]) - log(y[k - 1])) * log(re / x[k - 1]) / log(x[k] / x[k - 1]))
}
BEGIN {
  while ((getline line < REFERENCE) > 0) {
    split(line, f, ",")
    if (f[1] != "curve") continue
    re[++n] = f[2]; cd[n] = f[3]
    if (f[4] != "") { rest[++m] = f[2]; st[m] = f[4] }
  }
}
$2 == "body.reynolds" { reynolds[$1] = $3 }
$2 == "body.drag" && at(re, cd, n, reynolds[$1]) { print $1, "drag_ratio", $3 / at(re, cd, n, reynolds[$1]) }
$2 == "body.strouhal" && at(rest, st, m, reynolds[$1]) { print $1, "strouhal_ratio", $3 / at(rest, st, m, reynolds[$1]) }
