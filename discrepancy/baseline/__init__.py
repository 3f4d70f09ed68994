"""The metal that a diagnosis starts from: as the set states it, its flow curve, its own solve."""
