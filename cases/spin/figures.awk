# The line in 1/L through the two largest boxes, at 1/L = 0.
{ value[$1 " " $2] = $3 }
END {
  if ("box-100 body.drag" in value && "spin-1 body.drag" in value) {
    print "extrapolated", "drag", 2 * value["spin-1 body.drag"] - value["box-100 body.drag"]
    print "extrapolated", "lift", 2 * value["spin-1 body.lift"] - value["box-100 body.lift"]
  }
}
