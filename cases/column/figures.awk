# The columns and exponents of the benchmark's JSON, an object a line. "NAME KEY VALUE" of the exponents, and
# "NAME aspect-A VALUE" of each run-out.
function of(key, text) {
  if (!match($0, "\"" key "\": *(\"[^\"]*\"|[-+.0-9eE]+)")) return ""
  text = substr($0, RSTART, RLENGTH)
  sub(/^[^:]*: */, "", text)
  gsub(/"/, "", text)
  return text
}
function label(text) { gsub(/,/, "", text); gsub(/ /, "_", text); return text }
BEGIN {
  while ((getline < JSON) > 0) {
    if (of("fit") != "") { name = label(of("fit")); print name, "low", of("low"); print name, "high", of("high"); if (of("above") != "") print name, "above", of("above") }
    if (of("column") != "") print label(of("column")), "aspect-" of("aspect"), of("run_out")
  }
  exit
}
