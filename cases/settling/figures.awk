# The sediment's surface against a single jump; the hindered speed, and the exponent n of (1 - phi)^n that it means.
{ value[$1 " " $2] = $3 }
END {
  v = value["on settling.interface_speed"]; phi = value["on settling.concentration"]
  print "on", "front_ratio", value["on settling.front_speed"] / value["on settling.front_speed_kynch"]
  if (alone = value["alone body.speed"]) {
    print "on", "hindered", v / alone
    print "on", "exponent", log(v / alone) / log(1 - phi)
  }
}
