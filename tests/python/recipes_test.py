"""Every recipe of docs/guides/python.md runs as it stands there."""

import contextlib
import io
import os
import re
import unittest

from places import SOURCE, work_folder

PAGE = (SOURCE / "docs/guides/python.md").read_text()


class RecipeTest(unittest.TestCase):
    def test_recipes(self):
        recipes = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(recipes), 8)
        before, names = os.getcwd(), {}
        with work_folder() as folder:
            try:
                os.chdir(folder)
                os.symlink(SOURCE / "scenes", "scenes")
                for recipe in recipes:
                    with self.subTest(recipe.splitlines()[0]), contextlib.redirect_stdout(io.StringIO()):
                        exec(compile(recipe, "docs/guides/python.md", "exec"), names)  # pylint: disable=exec-used
                for file in re.findall(r'"(\w+\.(?:png|vdb|nvdb|brv|vxl))"', PAGE):
                    self.assertTrue(os.path.exists(file), file)
            finally:
                os.chdir(before)

    def test_pictures_of_the_page_exist(self):
        pictures = re.findall(r"\]\(\.\./(images/[^)]+)\)", PAGE)
        self.assertTrue(pictures)
        for picture in pictures:
            self.assertTrue((SOURCE / "docs" / picture).is_file(), picture)
        self.assertLess(sum(file.stat().st_size for file in (SOURCE / "docs/images/python").iterdir()), 200_000)

    def test_first_recipe(self):
        names = {}
        recipe = re.search(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL).group(1)
        exec(compile(recipe, "docs/guides/python.md", "exec"), names)  # pylint: disable=exec-used
        self.assertFalse(names["world"].visible((1, 1.6, 5), (15, 1.6, 5)))
        self.assertTrue(names["brume"].World(names["level"]).visible((1, 1.6, 5), (15, 1.6, 5)))


if __name__ == "__main__":
    unittest.main()
