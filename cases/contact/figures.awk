# The rows of the benchmark's JSON: objects with n, radius and the times of one search, grid_build_ms,
# linked200_build_ms and linked_tuned_build_ms, wherever they stand.
# "rRADIUS-nN KEY VALUE", of packed discs "packed-rRADIUS-nN", and the ratios of the linked cells to the grid.
function number(text, key) {
  if (!match(text, "\"" key "\": *[-+.0-9eE]+")) return ""
  text = substr(text, RSTART, RLENGTH)
  sub(/^[^:]*: */, "", text)
  return text + 0
}
BEGIN {
  while ((getline line < JSON) > 0) all = all line
  count = split(all, object, "{")
  for (k = 1; k <= count; k++) {
    n = number(object[k], "n"); grid = number(object[k], "grid_build_ms")
    if (n == "" || grid == "") continue
    if (number(object[k], "packed")) label = "packed-r" number(object[k], "radius") "-n" n
    else label = "r" number(object[k], "radius") "-n" n
    coarse = number(object[k], "linked200_build_ms"); tuned = number(object[k], "linked_tuned_build_ms")
    print label, "n", n
    print label, "radius", number(object[k], "radius")
    print label, "grid_ms", grid
    print label, "linked200_ms", coarse
    print label, "linked_tuned_ms", tuned
    if (grid > 0) { print label, "linked200_over_grid", coarse / grid; print label, "tuned_over_grid", tuned / grid }
    if (n > most && label ~ /^r/) { most = n; last = coarse / grid; lasttuned = tuned / grid }
  }
  if (most) { print "most", "n", most; print "most", "linked200_over_grid", last; print "most", "tuned_over_grid", lasttuned }
  exit
}
