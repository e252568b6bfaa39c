# From the second and third table of `delbm bench overlap`: the fitted factors, and the areas by cells of whole places.
/^fitted/ { table = 2 }
/^two discs/ { table = 3 }
table == 2 && $1 + 0 > 0 && NF == 4 { print "fit", "factor_" $1, $2; print "fit", "exponent_" $1, $4 }
table == 3 && NF == 4 && $1 ~ /^-?[0-9]/ { print "lens", "area_" $1, $2; print "cells", "area_" $1, $3 }
