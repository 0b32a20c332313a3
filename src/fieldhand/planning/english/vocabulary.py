"""The words that every robot and every orchard share: phrases by the terminal that they are to the grammar.

A phrase stands in its base form; verbs are inflected and nouns put in the plural by :mod:`.lexicon`. The longest phrase wins.
"""

from __future__ import annotations

#: Verbs, inflected by rule; a phrase inflects in its first word.
VERBS: dict[str, str] = {
    "TAKE": "take|get|grab|capture|collect|make|do|perform|record|obtain|acquire|gather|shoot|snap|run|carry out|fetch",
    "MEASURE": "measure|sample|read|check|probe|test|monitor|inspect|assess|scan|survey|examine|analyze|analyse|look at",
    "GO": "go|drive|move|head|travel|proceed|navigate|continue|continue driving|keep driving|drive on|go on|find|locate"
    "|choose|pick|select|approach|carry on|start|begin|make your way|drive over|go over|head over|look for",
    "VISIT": "visit|stop at|call at",
    "RETURN": "return|come back|go back|get back|drive back|head back|be back|end up|finish up|end|finish",
    "GOHOME": "go home|come home|return home|drive home|head home|be home",
    "STOP": "stop|quit|terminate|stop there|stop here|finish here|finish there|end the mission|finish the mission"
    "|stop the mission|abort|call it a day|end it there|stop working|do nothing else|do nothing more",
    "REPEAT": "repeat the same process|repeat the process|repeat this process|repeat that process|repeat the procedure"
    "|repeat the same procedure|repeat the steps|repeat the same steps|repeat these steps|repeat those steps|repeat this"
    "|repeat it|repeat that|repeat the same|repeat the same thing|repeat|do the same thing|do the same|do this again"
    "|do it again|do that again|do likewise|do the same again|do the same thing again|do all of that again|do all that again"
    "|do all this again|repeat all of that|repeat all that|repeat all this|repeat the sequence|repeat the measurement"
    "|repeat the measurements|repeat the same measurements|repeat the whole thing|do the whole thing again",
}

#: Nouns, put in the plural by rule.
NOUNS: dict[str, str] = {
    "TREE": "tree|vine|plant|trunk|bush|pistachio|pistachio tree|almond tree",
    "PLOT": "orchard|farm|field|site|block|plot|grove|vineyard|plantation|ground|property|area|map",
    "CORNER": "corner",
    "EDGE": "edge|border|boundary|fringe|margin|rim",
    "HALF": "half",
    "QUARTER": "quarter|quadrant",
    "SIDE": "side|part|section|portion|region",
    "MIDDLE": "middle|centre|center|midpoint|heart",
    "START": "start|starting point|start point|starting position|start marker|starting place|beginning|starting location"
    "|home base|home|base",
    "FINISH": "end|end point|endpoint|end marker|end position|finish|finish point|finish marker|exit|finishing point",
    "CHARGER": "charger|charging station|charge station|dock|charging dock|docking station|charging point",
    "PLACE": "spot|place|point|location|one|position",
    "READING": "reading|measurement|value|result|level|sample|figure|number|data point|finding|observation",
}

#: Words that stand as they are.
WORDS: dict[str, str] = {
    "DET": "a|an|the|this|that|these|those|my|our|its|their|some|his|her",
    "EACH": "each|every|all|both|each of|every one of|each one of|all of|both of|all the|any and every|every single"
    "|each and every",
    "ANY": "any|any one|any one of|one of|any of|some of|whichever|either|either of",
    "ANOTHER": "another|one more|yet another|a further|an additional|a new",
    "OTHER": "other|different|new|fresh|unvisited|remaining",
    "NEARBY": "nearby|near by|close by|neighbouring|neighboring|surrounding|in the vicinity|near there|near it|near here"
    "|close to it|close to there|around it|around there|near that tree|close at hand|near that|next door",
    "NEAREST": "nearest|closest|the nearest|the closest|nearest neighbour|nearest neighbor",
    "FAR": "far away|faraway|far|distant|far off|remote|far-off",
    "FARTHEST": "farthest|furthest|as far as possible|as far away as possible|most distant|farthest away|furthest away"
    "|as far as you can|as far away as you can|farthest tree|as far as it can|as distant as possible",
    "ADJACENT": "next to each other|next to one another|side by side|adjacent to each other|adjacent to one another"
    "|beside each other|beside one another|adjacent|that are next to each other|which are next to each other|in a pair"
    "|that are adjacent|standing side by side|standing next to each other|right next to each other|alongside each other"
    "|close to each other|near each other|next to another",
    "NEXTTO": "next to|beside|adjacent to|alongside|right by|right next to|immediately next to|neighbouring to|just beside",
    "NEAR": "near|close to|around|near to|by|in the vicinity of|nearest to|closest to|not far from",
    "INSIDE": "inside|inside of|within",
    "OUTSIDE": "outside|outside of",
    "OF": "of|belonging to",
    "FROM": "from|away from",
    "AT": "at|in|on|to|into|onto|over|along|across|throughout|toward|towards|around at|over at|in among|among|up to"
    "|located at|located in|situated in|up at|down at|down to|out to|standing in|standing at|growing in|with",
    "FOR": "for",
    "BY": "by means of",
    "EXCEPT": "except|except for|but not|excluding|apart from|other than|besides",
    "THERE": "there|here|at that place|at the same place|at the same tree|at that tree|at the same spot|at that spot"
    "|in the same place|at this tree|of it|at it|of that tree|of the same tree|there too|of that same tree|from it"
    "|at each of them|of each of them|at each one|of each one|at each|of each|at them|of them|at every one of them"
    "|of every one|from each of them|at every one|for each of them|for each|at each tree|of each tree|at both|of both"
    "|at both of them|of both of them|at the tree|of the tree|at each of these|of each of these|at each of those"
    "|of each of those|at every stop|at each stop|of this tree|at that one|of that one|at each of these trees"
    "|of each of these trees|at each of those trees|at all of them|of all of them",
    "AGAIN": "again|once more|one more time|a second time|another time",
    "MORE": "more|further|additional",
    "IF": "if|in case|provided|provided that|if and only if|only if|as long as|so long as|assuming|assuming that|should",
    "WHERE": "where|wherever|whenever|when|at those where|at any tree where|at any where|for those where|everywhere that"
    "|at trees where|at every tree where|for every tree where|for any tree where|at each tree where|for each tree where",
    "OTHERWISE": "otherwise|else|if not|or else|in any other case|in the other case|failing that|if it is not|if it isn't",
    "THEN": "then|after that|afterwards|afterward|after this|after|next|subsequently|once done|when done|finally|lastly"
    "|once finished|when finished|from there|from here|from that tree|in the end|at last|following that|thereafter"
    "|once that is done|when that is done|once you are done|when you are done|after which|once this is done"
    "|when you have finished|once you have finished|to begin with|first of all|to begin|secondly"
    "|thirdly|firstly|once there|when there|on arrival|last of all|after all that|before that is over|when it is done"
    "|once you get there|when you get there|once complete|when complete|once completed|as a last step"
    "|in the next step|step|and then|once all is done|when all is done|when finished there|once done there",
    "AND": "and|as well as|along with|plus|together with|and also|but|and then also",
    "OR": "or",
    "NOT": "not|never",
    "IS": "is|are|was|were|be|has|have|shows|show|reads|says|reports|gives|indicates|registers|stays|comes out|comes back"
    "|turns out|comes out at|turns out to be|remains|there is|there are|you get|it gets|measures|lies|falls|drops"
    "|appears|seems|looks|happens to be|came back|came out|we get|you find|you see|it finds|have a|has a|had|rises|goes"
    "|returns|happens to|ends up",
    "ISNOT": "isn't|aren't|wasn't|is not|are not|does not show|doesn't show|was not|were not|does not read|doesn't read",
    "STILL": "still|again still|once again|even|also still|remains still",
    "IT": "it|this one|that one|they|them|it's",
    "THANEQ": "than",
    "BETWEEN": "between|in between|from between|in the range|within the range",
    "WHICH": "that|which|that are|which are|that is|which is|that have|which have|that has|which has|whose|having"
    "|with a|with an|with the|that were|that was|being",
    "NOORDER": "in any order|in whatever order|in whichever order|no matter the order|in the best order|order does not matter"
    "|in any sequence|any order|in the shortest order|in no particular order|in an order of your choice",
    "INORDER": "in that order|in this order|in order|in the given order|in the order given|in turn|one after the other",
    "ASMANY": "as many|as many of|as many of the|as much of",
    "ASCAN": "as you can|as possible|as it can|as the robot can|as we can|as you are able|as you are able to|as can be"
    "|as it is able|as you are able to reach|as you can reach|as you manage|as you possibly can",
    "UPTO": "up to|at most|no more than|not more than|a maximum of|max|maximum",
    "TIMES": "times|time",
    "TRY": "if that fails|if it fails|if this fails|if that does not work|if it does not work|if you cannot|if you can't"
    "|if that doesn't work|if it doesn't work|if it cannot|if it can't|if the robot cannot|if the robot can't"
    "|if that is not possible|if this is not possible|if it is not possible|if that's not possible|if not possible",
    "WITHOUT": "without|never|do not|don't|while not",
    "BATTERY": "battery|charge|the battery|battery charge|battery level|state of charge|the charge|of the battery|of battery"
    "|of charge|of the charge|of its battery|of your battery|of energy|energy|of power|power|in the battery",
    "BEFORE": "before|by the time",
    "KEEP": "keep|leave|reserve|preserve|save|keep at least|leave at least|hold back|with at least|retain",
    "USE": "use|using|consume|consuming|spend|spending|spend at most|use up|burn",
    "LEFT": "left|remaining|over|in reserve|spare|to spare|left over",
    "LIMIT": "in total|altogether|all in all|overall|of driving|total|in all|driven",
    "EVERYWHERE": "everywhere|all over|all around|across the board",
}

#: Words that mean nothing to the plan, and are known not to.
FILLER = (
    "please|kindly|just|simply|also|too|as well|well|now|the robot|robot|send the robot|have the robot|tell the robot"
    "|send the robot out|send it|let the robot|i would like you|i'd like you|i would like|i'd like|i want you|i want|we want"
    "|we would like|we'd like|we need|i need|i need you|we need you|you should|you must|the robot should|the robot must"
    "|can you|could you|would you|will you|let's|let us|make sure|be sure|remember|thank you|thanks|hello|hi|hey|dear robot"
    "|ok|okay|good morning|somewhere|random|randomly|some random|arbitrary|right|exactly|precisely|actually|quickly|carefully"
    "|good|quick|fresh look|viewing this farm as a rectangle|viewing the farm as a rectangle|viewed as a rectangle"
    "|viewing this orchard as a rectangle|viewing the orchard as a rectangle|seen as a rectangle|treating it as a rectangle"
    "|if you view the farm as a rectangle|viewing this field as a rectangle|viewing the field as a rectangle"
    "|treating the farm as a rectangle|treating the orchard as a rectangle|treating the field as a rectangle"
    "|considering the farm as a rectangle|viewed as rectangle|thinking of the orchard as a rectangle"
    "|thinking of the farm as a rectangle|out|so|instead|instead of that|respectively|separately|individually|once"
    "|at that point|in that case|in this case|in which case|then you can|you can|average|mean|current|whole|entire|full"
    "|complete|single|own|go ahead|get going|get started|your job is|your task is|the task is|the job is|the plan is"
    "|we are going|i am going|you are|very|really|particular|its|their|for me|for us|kind of|the same way|mission"
    "|go to and|head out and|drive around and|drive around|use your camera|with your camera|with the camera"
    "|with the sensor|using the camera|using the thermal camera|with the thermal camera|tree by tree|one by one"
)

#: Words with which a reason begins; it runs to the end of the clause.
PURPOSE = (
    "so that we|so that i|so we can|so i can|so that the|because|in order to|so as to|since we|since i|to see|to find out"
    "|to make sure|to confirm|to double check|to be sure|to check for|to know|as we want|as i want|so that|to verify"
    "|for the record|to learn|to compare|as a precaution|as a baseline|for our records|for my records|to get an idea"
    "|for reference|for comparison|to understand|to help|to detect|to be safe|to decide|to keep an eye"
)

#: What this version knows of but cannot do yet, with what to say instead.
NOT_YET: dict[str, str] = {
    "row|rows|aisle|aisles|headland|headlands": "rows are not known yet; name trees by id, side, corner or attribute",
    "trees down|trees up|trees further|trees along|tree down|tree up|trees over|trees away|down the row|up the row"
    "|along the row|trees ahead": "counting trees along a row is not possible yet; say 'the tree next to', 'nearby' or a tree's id",
    "apart": "stops at a spacing are not possible yet; name trees",
    "wait|sleep|pause": "waiting is not something that a plan can hold yet; leave it out",
    "every other|every second|every third|every fourth|alternate|every 2nd|every 3rd": "'every other' needs rows, which are not"
    " known yet; name trees by id, side, corner or attribute",
    "until": "'until' is not understood yet; say how many times, or which trees",
    "unless": "'unless' is not understood yet; say 'if ... not'",
}

NUMBERS = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty"]
TENS = {
    "thirty": 30,
    "forty": 40,
    "fifty": 50,
    "sixty": 60,
    "seventy": 70,
    "eighty": 80,
    "ninety": 90,
    "hundred": 100,
    "a hundred": 100,
    "one hundred": 100,
    "two hundred": 200,
    "dozen": 12,
    "a dozen": 12,
    "half a dozen": 6,
    "a couple of": 2,
    "a couple": 2,
    "couple of": 2,
    "a pair of": 2,
    "pair of": 2,
    "a trio of": 3,
}
ORDINALS = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"]
COUNTS = {"twice": 2, "two times": 2, "thrice": 3, "three times": 3}

SIDES = {
    "north": "north",
    "northern": "north",
    "east": "east",
    "eastern": "east",
    "south": "south",
    "southern": "south",
    "west": "west",
    "western": "west",
    "northerly": "north",
    "southerly": "south",
    "easterly": "east",
    "westerly": "west",
}
COMPASS_CORNERS = {"ne": "ne", "nw": "nw", "se": "se", "sw": "sw"}

COMPARE: dict[str, str] = {
    "lt": "less than|below|under|lower than|colder than|cooler than|smaller than|fewer than|beneath|short of|is below"
    "|is less than|goes below|drops below|falls below|falls under|drops under|drier than",
    "gt": "more than|above|over|greater than|higher than|hotter than|warmer than|exceeding|exceeds|exceed|larger than"
    "|bigger than|in excess of|goes above|rises above|wetter than|beyond|is above|is over",
    "le": "at most|no more than|not more than|no higher than|not above|not over|or less|maximum|up to|no greater than"
    "|not exceeding|at or below|less than or equal to",
    "ge": "at least|no less than|not less than|not below|not under|no lower than|minimum|at or above|more than or equal to"
    "|greater than or equal to|a minimum of",
    "eq": "equal to|equals|exactly",
}
#: Comparisons that say which attribute they compare.
COMPARE_ATTRIBUTE = {
    "older than": ("gt", "age"),
    "younger than": ("lt", "age"),
    "taller than": ("gt", "height"),
    "shorter than": ("lt", "height"),
    "heavier than": ("gt", "weight"),
}
SUPERLATIVES: dict[str, tuple[str, bool]] = {
    "highest": ("", False),
    "largest": ("", False),
    "biggest": ("", False),
    "greatest": ("", False),
    "most": ("", False),
    "best": ("", False),
    "top": ("", False),
    "maximum": ("", False),
    "lowest": ("", True),
    "smallest": ("", True),
    "least": ("", True),
    "fewest": ("", True),
    "worst": ("", True),
    "poorest": ("", True),
    "oldest": ("age", False),
    "youngest": ("age", True),
    "tallest": ("height", False),
    "shortest": ("height", True),
    "heaviest": ("weight", False),
    "lightest": ("weight", True),
    "highest yielding": ("yield", False),
    "lowest yielding": ("yield", True),
    "most productive": ("yield", False),
    "least productive": ("yield", True),
    "most valuable": ("reward", False),
    "least valuable": ("reward", True),
    "most rewarding": ("reward", False),
}
LEVELS = {
    "low": "low",
    "high": "high",
    "too low": "low",
    "too high": "high",
    "lower": "low",
    "too hot": "high",
    "hot": "high",
    "too cold": "low",
    "cold": "low",
    "cool": "low",
    "warm": "high",
    "too warm": "high",
    "dry": "low",
    "too dry": "low",
    "wet": "high",
    "too wet": "high",
    "normal": "normal",
    "elevated": "high",
    "on the low side": "low",
    "on the high side": "high",
    "too cool": "low",
    "pretty low": "low",
    "pretty high": "high",
    "moderate": "moderate",
    "medium": "medium",
    "a low": "low",
    "a high": "high",
}
ALIASES: dict[str, str] = {
    "age": "age|year|years old|old",
    "yield": "yield|production|crop",
    "reward": "reward|value|score|prize",
    "color": "color|colour",
    "colour": "color|colour",
    "variety": "variety|cultivar|kind|type",
    "height": "height|tall",
}

#: Units by the words for them: (kind, unit, factor to the base unit, offset).
UNITS: dict[str, tuple[str, float, float]] = {
    "m|meter|meters|metre|metres": ("metres", 1.0, 0.0),
    "km|kilometer|kilometers|kilometre|kilometres": ("metres", 1000.0, 0.0),
    "ft|foot|feet": ("metres", 0.3048, 0.0),
    "yd|yard|yards": ("metres", 0.9144, 0.0),
    "mile|miles": ("metres", 1609.344, 0.0),
    "s|sec|secs|second|seconds": ("seconds", 1.0, 0.0),
    "min|mins|minute|minutes": ("seconds", 60.0, 0.0),
    "h|hr|hrs|hour|hours": ("seconds", 3600.0, 0.0),
    "%|percent|per cent|pct": ("percent", 1.0, 0.0),
    "c|°c|° c|degree|degrees|degree c|degrees c|degree celsius|degrees celsius|celsius|centigrade|degrees centigrade|degc|deg c"
    "|deg|°": ("degC", 1.0, 0.0),
    "f|°f|° f|degree f|degrees f|degree fahrenheit|degrees fahrenheit|fahrenheit|degf|deg f": ("degC", 5 / 9, -160 / 9),
    "ppm|parts per million": ("ppm", 1.0, 0.0),
    "year|years|years old|year old|yrs|years of age": ("years", 1.0, 0.0),
    "kg|kilo|kilos|kilogram|kilograms": ("kg", 1.0, 0.0),
}
